"""Damage to the bytes of a file, the same for the same random numbers."""

import re

import numpy as np

# Bytes at the beginning that are damaged as often as all others together.
HEAD = 500
INTEGERS = [0, 1, 6, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000]
DECIMALS = np.float32([np.nan, np.inf, -3e38, 3e38, 1e-45])
TEXTS = [b"nan", b"-inf", b"1e999", b"-1", b"0", b"4294967296", b"88888888888", b"", b"x y", b"-2147483649"]


def damaged(data: bytes, random: np.random.Generator) -> bytes:
    """Return the content of a file with one to three damages."""
    for _ in range(random.integers(1, 4)):
        within = HEAD if random.random() < 0.5 else len(data)
        at = int(random.integers(max(1, min(within, len(data)))))
        data = DAMAGES[random.integers(len(DAMAGES))](data, at, random)
    return data


def _cut(data, at, random):
    return data[:at]


def _flip(data, at, random):
    return data[:at] + bytes(byte ^ (1 << random.integers(8)) for byte in data[at : at + 3]) + data[at + 3 :]


def _drop(data, at, random):
    return data[:at] + data[at + random.integers(1, 30) :]


def _repeat(data, at, random):
    return data[: at + random.integers(1, 100)] + data[at:]


def _integer(data, at, random):
    at -= at % 4
    return data[:at] + int(random.choice(INTEGERS)).to_bytes(4, "little") + data[at + 4 :]


def _decimal(data, at, random):
    return data[:at] + random.choice(DECIMALS).tobytes() + data[at + 4 :]


def _number(data, at, random):
    """Another text in place of a number behind this place."""
    number = re.compile(rb"-?\d+(\.\d+)?").search(data, at)
    return (
        data if number is None else data[: number.start()] + TEXTS[random.integers(len(TEXTS))] + data[number.end() :]
    )


DAMAGES = [_cut, _flip, _drop, _repeat, _integer, _decimal, _number, _number]
