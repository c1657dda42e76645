"""Processes that do files, here or on a cluster: how they are started, watched, limited and ended."""
