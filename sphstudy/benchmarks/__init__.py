"""This program and others, timed."""
