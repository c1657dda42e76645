"""Damaged files: what is looked at before Blender opens one, and sentences for what its readers say."""
