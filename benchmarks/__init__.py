"""One script a table of docs/benchmarks.md; run as ``python -m benchmarks.NAME --data DIR``."""
