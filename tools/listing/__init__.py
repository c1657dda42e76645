"""What the page of an extension site shows: icon, pictures and description; run as ``python -m tools.listing``."""

from tools.extension import load_extension

# From here on the checkout can be imported as the package ``eigenparts``.
load_extension()
