"""Long work on values alone, in Blender or in its worker process: knows the engine, and no Blender."""
