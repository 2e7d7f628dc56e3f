"""`sphstudy study speed`: how fast the program is on this machine. What it measures are rates, not runs.

Seconds are CPU seconds, medians over rounds in which all variants take turns, so that whatever else the
machine does meets them alike. They hold for the machine they come from: compare ratios, not seconds.
"""
