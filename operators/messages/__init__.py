"""Sentences for the user: refusals, unexpected errors, other languages. Imports no other room."""
