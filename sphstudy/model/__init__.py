"""What is simulated: bodies, problems, scenes, and the exact answers to them."""
