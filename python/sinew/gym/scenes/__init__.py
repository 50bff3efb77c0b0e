"""Robots of the tasks: scene files, and scenes whose meshes are generated when a task is loaded."""
