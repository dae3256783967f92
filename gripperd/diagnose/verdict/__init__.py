"""What is said of an explanation: named, where, how much better, what next."""
