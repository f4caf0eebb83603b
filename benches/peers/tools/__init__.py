"""The tools compared, one a file."""
