"""Figures, tables and pages, made from stored data only: nothing here runs a simulation."""
