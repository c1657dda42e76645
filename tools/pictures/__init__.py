"""The pictures of the documentation; run as ``python -m tools.pictures``."""

from tools.extension import load_extension

# From here on the checkout can be imported as the package ``eigenparts``.
load_extension()
