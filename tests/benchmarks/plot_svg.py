"""Small line charts as SVG, without any package: what tests/benchmarks/growth.py draws."""

import math

WIDTH, HEIGHT = 440, 320
LEFT, RIGHT, TOP, BOTTOM = 62, 16, 34, 46
INK, GRID, LINE, GUIDE = "#333", "#ddd", "#1f6fb4", "#999"


def text(x, y, content, anchor="middle", extra=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="12" '
            f'font-family="sans-serif" fill="{INK}"{extra}>{content}</text>')


def line(points, colour, dashed=False):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    dash = ' stroke-dasharray="5 4"' if dashed else ""
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.6"{dash}/>'


def short(value):
    """1024 -> 1k, 0.5 -> 0.5."""
    if value >= 1024 and value % 1024 == 0:
        return f"{value // 1024:.0f}k"
    return f"{value:g}"


def log_ticks(low, high):
    """1, 2 and 5 times powers of ten within low..high, at most about eight."""
    ticks = [m * 10.0 ** e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
             for m in (1, 2, 5)]
    ticks = [t for t in ticks if low <= t * 1.0001 and t <= high * 1.0001]
    return ticks if len(ticks) <= 8 else [t for t in ticks if f"{t:e}".startswith("1")]


def linear_ticks(high):
    step = 10 ** math.floor(math.log10(high / 2))
    while high / step > 6:
        step *= 2 if f"{step:e}"[0] in "15" else 2.5
    return [i * step for i in range(int(high / step) + 1)]


class Chart:
    """One chart: x logarithmic with a tick at every point, y logarithmic or from zero."""

    def __init__(self, title, x_label, xs, ys, log_y, guide=None):
        self.title, self.x_label, self.xs, self.ys = title, x_label, xs, ys
        self.log_y = log_y
        self.guide = guide or []  # (name, [y of every x])
        every = list(ys) + [y for _, values in self.guide for y in values]
        self.low, self.high = (min(every) / 1.3, max(every) * 1.3) if log_y else (0, max(every) * 1.1)

    def x(self, value):
        low, high = math.log(self.xs[0] / 1.15), math.log(self.xs[-1] * 1.15)
        return LEFT + (math.log(value) - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    def y(self, value):
        scale = math.log if self.log_y else float
        low, high = scale(self.low), scale(self.high)
        return HEIGHT - BOTTOM - (scale(value) - low) / (high - low) * (HEIGHT - TOP - BOTTOM)

    def axes(self):
        parts = [text(LEFT, 20, self.title, "start", ' font-weight="bold"'),
                 text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, self.x_label)]
        for tick in log_ticks(self.low, self.high) if self.log_y else linear_ticks(self.high):
            y = self.y(tick)
            parts += [line([(LEFT, y), (WIDTH - RIGHT, y)], GRID), text(LEFT - 6, y + 4, short(tick), "end")]
        for value in self.xs:
            x = self.x(value)
            parts += [line([(x, TOP), (x, HEIGHT - BOTTOM)], GRID),
                      text(x, HEIGHT - BOTTOM + 16, short(value))]
        return parts

    def svg(self):
        parts = self.axes()
        for name, values in self.guide:
            points = [(self.x(x), self.y(y)) for x, y in zip(self.xs, values)]
            parts += [line(points, GUIDE, dashed=True),
                      text(points[-1][0] - 6, points[-1][1] - 6, name, "end", ' font-style="italic"')]
        points = [(self.x(x), self.y(y)) for x, y in zip(self.xs, self.ys)]
        parts.append(line(points, LINE))
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" fill="{LINE}"/>' for x, y in points]
        return parts


def write(path, charts):
    """Charts side by side in one file."""
    width = WIDTH * len(charts)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{HEIGHT}" '
             f'viewBox="0 0 {width} {HEIGHT}">', f'<rect width="{width}" height="{HEIGHT}" fill="white"/>']
    for i, chart in enumerate(charts):
        parts += [f'<g transform="translate({i * WIDTH} 0)">', *chart.svg(), "</g>"]
    with open(path, "w", encoding="ascii") as file:
        file.write("\n".join([*parts, "</svg>"]) + "\n")
