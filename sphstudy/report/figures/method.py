"""The method in pictures: kernel, discretised sum, cracks and lines of sight (thesis chapter 2)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from sphstudy.analysis.results import Results
from sphstudy.model.lattice import lattice
from sphstudy.numerics.sph.crack import Crack, line_of_sight, visible
from sphstudy.numerics.sph.kernel import KERNELS, value
from sphstudy.report.drawing import TEXT_WIDTH, built, first_configuration, particles
from sphstudy.report.figure import figure


@figure(
    "2.1",
    "The kernel in one dimension, compared to a Gaussian of the same area and the same second moment.",
)
def kernel(results: Results) -> Figure:
    """h W over distance in units of h."""
    spline = KERNELS[first_configuration(results, "plate").method.kernel]
    q = np.linspace(-1.25 * spline.support, 1.25 * spline.support, 2001)
    shape = np.array([value(spline, abs(distance)) for distance in q])
    shape /= np.trapezoid(shape, q)
    variance = np.trapezoid(q**2 * shape, q)
    gaussian = np.exp(-(q**2) / (2.0 * variance)) / np.sqrt(2.0 * np.pi * variance)

    drawing = Figure(layout="constrained")
    axes = drawing.add_subplot()
    axes.plot(q, shape, label="kernel $W$")
    axes.plot(q, gaussian, "--", label=f"Gaussian, variance {variance:.3f} $h^2$")
    axes.set_xlabel("$(x - x_i)/h$")
    axes.set_ylabel("$h\\,W(x - x_i)$")
    axes.set_xlim(q[0], q[-1])
    axes.set_ylim(0.0, 1.25 * gaussian.max())
    axes.legend(loc="upper right")
    return drawing


@figure(
    "2.2",
    "The discretised sum: left, the particles inside the support of the kernel around particle i and the "
    "kernel (shaded); right, the values with which they are weighted. Weights times areas of the "
    "particles add up to nearly one.",
)
def discretised_sum(results: Results) -> Figure:
    """Particles in the middle of the plate, in coordinates about particle i in units of h."""
    config = first_configuration(results, "plate")
    body = built(config).body
    spline = KERNELS[config.method.kernel]
    h = config.h * body.mean_spacing
    centre = np.argmin(np.hypot(body.x - body.x.mean(), body.y - body.y.mean()))
    x, y = (body.x - body.x[centre]) / h, (body.y - body.y[centre]) / h
    q = np.hypot(x, y)
    # h² W, so that the numbers belong to no particular resolution.
    weight = spline.scale * np.array([value(spline, distance) for distance in q])
    inside = q < spline.support
    around = inside & (q > 0.0)
    total = np.sum(weight * body.mass) / (config.scene.rho * h**2)

    drawing = Figure(figsize=(TEXT_WIDTH, 3.6), layout="constrained")
    plan, profile = drawing.subplots(1, 2)
    reach = 1.35 * spline.support
    _shade_kernel(plan, spline, reach)
    shown = ~inside & (np.maximum(np.abs(x), np.abs(y)) < reach)
    particles(plan, x[shown], y[shown], "reference", label="outside the support")
    particles(plan, x[around], y[around], "neighbour", label="neighbour of i")
    particles(plan, x[[centre]], y[[centre]], "observer", label="particle i")
    plan.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    plan.set_xlabel("$(x - x_i)/h$")
    plan.set_ylabel("$(y - y_i)/h$")
    plan.grid(False)

    line = np.linspace(0.0, reach, 400)
    profile.plot(line, [spline.scale * value(spline, s) for s in line], color="0.6", label="kernel")
    profile.vlines(q[around], 0.0, weight[around], color="C2", linewidth=0.8)
    particles(profile, q[around], weight[around], "neighbour", clip_on=False)
    particles(profile, q[[centre]], weight[[centre]], "observer", clip_on=False)
    profile.set_xlabel("$|\\mathbf{x}_j - \\mathbf{x}_i|/h$")
    profile.set_ylabel("$h^2\\,W_{ij}$")
    profile.set_ylim(bottom=0.0)
    profile.set_title(f"$\\sum_j W_{{ij}}\\,A_j = {total:.4f}$")
    drawing.legend(*plan.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawing


def _shade_kernel(axes: Axes, spline, reach: float) -> None:
    line = np.linspace(-reach, reach, 121)
    radius = np.hypot(*np.meshgrid(line, line))
    height = np.array([value(spline, s) for s in radius.ravel()]).reshape(radius.shape)
    axes.imshow(
        height,
        extent=(-reach, reach, -reach, reach),
        cmap="Greys",
        interpolation="bilinear",
        vmax=1.8 * height.max(),
    )
    axes.add_patch(Circle((0.0, 0.0), spline.support, fill=False, linestyle="--", color="0.3"))


@figure(
    "2.3",
    "A crack of straight segments. (a) Its nodes float half-way between pairs of particles (joined by "
    "thin lines), so that it moves with the material. (b) Particle i has as neighbours those particles "
    "in its support (dashed) that it sees; one behind the crack is hidden.",
)
def crack_segments(results: Results) -> Figure:
    """Two linked segments in deformed material, and lines of sight past one segment."""
    config = first_configuration(results, "plate")
    drawing = Figure(figsize=(TEXT_WIDTH, 3.6), layout="constrained")
    floating, sight = drawing.subplots(1, 2)
    _floating_crack(floating)
    reach = KERNELS[config.method.kernel].support * config.h
    _lines_of_sight(sight, reach, config.method.visibility_tolerance)
    for axes, title in ((floating, "(a) floating nodes"), (sight, "(b) visibility")):
        axes.set_title(title)
        axes.set(aspect="equal", xlim=(-1.0, 7.2), ylim=(-1.0, 6.2))
        axes.grid(False)
        axes.set_xlabel("$x/\\Delta x$")
        axes.set_ylabel("$y/\\Delta y$")
    entries = {
        label: handle
        for axes in (floating, sight)
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    drawing.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=4)
    return drawing


def _material() -> tuple[np.ndarray, np.ndarray]:
    """Particles (spacing 1) of a lattice of six rows and seven columns, bent and sheared."""
    x, y = lattice(np.arange(7.0), np.arange(6.0))
    return x + 0.12 * y + 0.08 * np.sin(2.0 * x), y + 0.03 * (x - 3.0) ** 2 + 0.08 * np.cos(2.0 * x)


def _floating_crack(axes: Axes) -> None:
    x, y = _material()
    # Pairs of particles, numbered row by row in rows of seven: below and above the crack.
    crack = Crack(np.array([14, 17, 33]), np.array([21, 24, 40]))
    _, _, node_x, node_y, *_ = line_of_sight(crack, x, y)
    for pair in zip(crack.first, crack.second, strict=True):
        axes.plot(x[list(pair)], y[list(pair)], color="C0", linewidth=1.0)
    paired = np.zeros(x.size, dtype=bool)
    paired[[*crack.first, *crack.second]] = True
    particles(axes, x[~paired], y[~paired], "free", label="particle")
    particles(axes, x[paired], y[paired], "marked", label="carries a node")
    axes.plot(node_x, node_y, "D-", color="C1", linewidth=2.0, label="crack segment")


def _lines_of_sight(axes: Axes, reach: float, tolerance: float) -> None:
    """Judges every pair that particle i forms inside its support, as it is judged in a run."""
    x, y = _material()
    observer = 16
    crack = Crack(np.array([29, 11]), np.array([36, 18]), tolerance)
    *_, node_x, node_y, tolerance, _ = line_of_sight(crack, x, y)
    distance = np.hypot(x - x[observer], y - y[observer])
    inside = (distance < reach) & (distance > 0.0)
    seen = np.array(
        [
            visible(x[observer], y[observer], *point, node_x, node_y, tolerance)
            for point in zip(x, y, strict=True)
        ]
    )
    for chosen, colour, line in ((inside & seen, "C2", "-"), (inside & ~seen, "0.55", ":")):
        ends_x, ends_y = (np.broadcast_to(c[observer], c[chosen].shape) for c in (x, y))
        axes.plot([ends_x, x[chosen]], [ends_y, y[chosen]], line, color=colour, linewidth=0.9, zorder=1.5)
    for chosen, kind, label in (
        (distance >= reach, "reference", "outside the support"),
        (inside & seen, "neighbour", "neighbour of i"),
        (inside & ~seen, "hidden", "hidden from i"),
        (distance == 0.0, "observer", "particle i"),
    ):
        particles(axes, x[chosen], y[chosen], kind, label=label)
    axes.plot(node_x, node_y, "D-", color="C1", linewidth=2.0, label="crack segment")
    axes.add_patch(Circle((x[observer], y[observer]), reach, fill=False, linestyle="--", color="0.3"))
