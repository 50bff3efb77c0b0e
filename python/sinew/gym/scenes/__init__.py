"""The robots of the tasks: scenes as files, and scenes with meshes that are generated when a task is loaded."""
