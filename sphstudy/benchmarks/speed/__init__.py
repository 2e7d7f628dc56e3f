"""`sphstudy speed`: how fast the program is on this machine. It measures rates, not runs of a study.

Seconds are CPU seconds, medians over rounds in which all variants take turns, so that other load of the
machine meets them alike. They hold for the machine they come from: compare ratios, not seconds.
"""
