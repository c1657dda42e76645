"""The two ways to read a level; plain names, so that menus and command lines can be made from them at once."""

# What lies between features is a part too: all levels up to the chosen one are overlaid.
NESTED = "nested"
# Only the features that protrude are parts.
FEATURES = "features"
# The default first.
MODES = (NESTED, FEATURES)
