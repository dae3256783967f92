"""What nobody can name, as a smooth function inside a fence: no physics."""
