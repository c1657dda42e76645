"""The heavy step, and what is read from its result. Imports all that stands before it on the path of the data."""
