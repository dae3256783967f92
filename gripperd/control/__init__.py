"""What to do, and when it is allowed."""
