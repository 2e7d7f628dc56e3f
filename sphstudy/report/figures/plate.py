"""Vibrating plate: motion of the tip, errors of frequency and amplitude (thesis 3.1, 4.1)."""

import numpy as np
from matplotlib.figure import Figure

from sphstudy.analysis.results import Results
from sphstudy.model.exact import beam
from sphstudy.report.figure import figure, figures
from sphstudy.report.series import PERCENT, RADIUS, curves, legend_above, ring_unstable, zero_line
from sphstudy.store.record import configuration

_MILLIMETRE = 1e-3


@figure(
    "3.3",
    "Displacement of the tracked particle (end of the centreline) in cell (n_y, h̃) = (21, 1.5) over "
    "one period: samples of the run (every tenth), the least-squares fit A exp(-κt) sin ωt (3.3), and "
    "the Euler-Bernoulli beam (3.1) at that particle. The thesis shows the same three without naming "
    "the cell.",
)
def tip_displacement(results: Results) -> Figure:
    cell = {"h": 1.5, "n": 21}
    run = results.record(cell, block="grid")
    amplitude, decay, omega = (
        results.value(name, cell, block="grid") for name in ("amplitude", "decay_rate", "frequency")
    )
    scene = configuration(run).scene
    beam_omega = beam.fundamental_frequency(scene.E, scene.rho, scene.L, scene.L / scene.slenderness)
    shape = float(beam.mode_shape(float(run["reference_x"].max()), scene.L))
    samples, u_y = run["history_time"].values, run["history_u_y"].values
    time = np.linspace(0.0, samples[-1], 400)
    fit = amplitude * np.exp(-decay * time) * np.sin(omega * time)
    exact = scene.H0 * scene.L * shape * np.sin(beam_omega * time)

    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    axes.plot(samples[::10], u_y[::10] / _MILLIMETRE, "o", markersize=4, label="SPH")
    axes.plot(time, fit / _MILLIMETRE, label="fit (3.3)")
    axes.plot(time, exact / _MILLIMETRE, "--", color="0.2", label="beam (3.1)")
    zero_line(axes)
    axes.set(xlabel="time $t$ (s)", ylabel="displacement of the tip $u_y$ (mm)")
    legend_above(drawing, axes, columns=3)
    return drawing


@figures(
    frequency_error=(
        "4.2a",
        "Relative error of the fitted angular frequency ω against ω0 of the Euler-Bernoulli beam, over "
        "the relative smoothing radius h̃, for each number n_y of rows, after one period. The thesis: "
        "all errors are negative, the smallest about -3 %, and shrink as n_y grows, except at h̃ = 1.3. "
        "Rings: cells in an instability, whose values react to anything.",
        "frequency_error",
        "error of frequency $(\\omega-\\omega_0)/\\omega_0$ (%)",
    ),
    amplitude_error=(
        "4.2b",
        "Relative error of the fitted amplitude A against H0, over the relative smoothing radius h̃, "
        "for each number n_y of rows, after one period. The thesis: all errors are positive, the "
        "smallest about 3 %, and shrink as n_y grows, except at h̃ = 1.3. Rings: cells in an "
        "instability.",
        "amplitude_error",
        "error of amplitude $(A-H_0)/H_0$ (%)",
    ),
    frequency_error_2d=(
        "frequency in two dimensions",
        "The frequencies of figure 4.2a against two-dimensional elasticity (finite elements, the body "
        "that the particles stand for), which counts shear, rotatory inertia and plane strain, as the "
        "beam does not. Rings: cells in an instability.",
        "frequency_error_2d",
        "error of $\\omega$ against 2-D elasticity (%)",
    ),
)
def _errors(results: Results, metric: str, label: str) -> Figure:
    grid = PERCENT * results.grid(metric)
    drawing = Figure(layout="constrained")
    axes = drawing.subplots()
    curves(axes, grid, "n_y")
    ring_unstable(axes, results, grid)
    axes.set(xlabel=RADIUS, ylabel=label)
    legend_above(drawing, axes, columns=4)
    return drawing
