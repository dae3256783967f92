"""A recording against a model: what each stage should read, and what is left."""
