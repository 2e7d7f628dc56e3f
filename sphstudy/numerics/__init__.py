"""How a problem is computed: operators, methods, solvers; arrays in, arrays out."""
