"""Exact answers, and finite-element references where there is none in closed form."""
