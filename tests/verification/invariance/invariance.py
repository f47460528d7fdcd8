"""The same physical problem in other units, and with all heights shifted: equal contact sets and counts of steps, scaled errors and bounds.

usage: invariance.py PROGRAM SCRATCH_FOLDER [arguments of unittest]

Lengths x -> b x, tensions mu -> m mu, displacements u -> a u: forces and multipliers take the factor m a / b², times b² / m (the mass is 1),
energy norms sqrt(m) a, in time sqrt(m) a sqrt(b² / m). The data of catalogued cases are written as expressions of scaled coordinates.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml

try:
    import h5py
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-h5py)")
    sys.exit(77)

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])


class Units:
    def __init__(self, name, length=1.0, tension=1.0, displacement=1.0, shift=0.0):
        self.name, self.length, self.tension, self.displacement, self.shift = name, length, tension, displacement, shift

    @property
    def force(self):
        return self.tension * self.displacement / self.length**2

    @property
    def time(self):
        return self.length**2 / self.tension

    @property
    def energy(self):
        return math.sqrt(self.tension) * self.displacement


ONE = Units("one")
SYSTEMS = (
    Units("centimetres", 1e-2, 1e7, 1e-5),
    Units("smallest lengths", 1e-6, 1e9, 1e-9),
    Units("largest lengths", 1e3, 1e-6, 1e3),
    Units("soft and small", 0.1, 1e-6, 1e-9),
)


def scaled(factor, formula, shift=0.0):
    return f"{factor!r}*({formula})" + (f" + {shift!r}" if shift else "")


class Deck:
    """A scene in units of one: functions of X, Y, rho, T by the kind of what they give."""

    def __init__(self, name, model, functions, method, mesh, constants=None, centre=(0.5, 0.5), interface=None, nested=False, target=None,
                 gap=0.1, step=None, end=None, newton=None):
        self.name, self.model, self.functions, self.method, self.mesh = name, model, functions, method, mesh
        self.constants, self.centre, self.interface, self.target = constants or {}, centre, interface, target
        self.nested, self.gap, self.step, self.end, self.newton = nested, gap, step, end, newton or {}

    def rounding(self, units):
        """What the bound sees of the rounding of shifted heights: eps |height| along the boundary, whose derivative in a face of length h
        is p²/h times as large."""
        faces = self.mesh["cells per side"] * 2 ** self.mesh.get("refinements", 0)
        return sys.float_info.epsilon * abs(units.shift) * self.gap * self.method["degree"] ** 2 * faces

    def formula(self, kind, text, units):
        b, T = units.length, units.time
        for symbol, value in (("X", f"(x/{b!r})"), ("Y", f"(y/{b!r})"), ("rho", f"(r/{b!r})"), ("TIME", f"(t/{T!r})")):
            text = text.replace(symbol, value)
        a = units.displacement
        return {
            "tension": lambda: scaled(units.tension, text),
            "force": lambda: scaled(units.force, text),
            "height": lambda: scaled(a, text, units.shift * self.gap * a),
            "slope": lambda: scaled(a / b, text),
        }[kind]()

    def write(self, folder, units):
        b = units.length
        deck = xml.Element("ParameterList", name="thixis")

        def block(parent, name):
            return xml.SubElement(parent, "ParameterList", name=name)

        def put(parent, name, kind, value):
            xml.SubElement(parent, "Parameter", name=name, type=kind, value=value)

        scene = block(deck, "scene")
        put(scene, "model", "string", self.model)
        if self.interface:
            put(scene, "interface", "string", self.formula("height", self.interface, Units("", length=b)))
        data = block(scene, "data")
        for name, (kind, text) in self.functions.items():
            put(data, name, "string", self.formula(kind, text, units))
        put(data, "centre", "Array(double)", "{%r, %r}" % tuple(b * c for c in self.centre))
        mesh = block(deck, "mesh")
        for name, value in self.mesh.items():
            put(mesh, name, "string" if isinstance(value, str) else "int", str(value))
        put(mesh, "lower", "Array(double)", "{0.0, 0.0}")
        put(mesh, "upper", "Array(double)", "{%r, %r}" % (b, b))
        method = block(deck, "method")
        for name, value in self.method.items():
            put(method, name, "string" if isinstance(value, str) else "int", str(value))
        put(block(deck, "linear"), "solver", "string", "direct")
        newton = block(deck, "newton")
        for name, value in self.newton.items():
            put(newton, name, "string", value)
        stopping = block(deck, "stopping")
        put(stopping, "estimate", "bool", "true")
        if self.target:
            put(stopping, "target", "double", repr(self.target * units.energy))
        if self.step:
            time = block(deck, "time")
            put(time, "step", "double", repr(self.step * units.time))
            put(time, "end", "double", repr(self.end * units.time))
        put(block(deck, "output"), "fields", "string", "active")
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "deck.xml"
        xml.ElementTree(deck).write(path)
        return path

    def run(self, units):
        folder = SCRATCH / self.name.replace(" ", "_") / units.name.replace(" ", "_")
        path = self.write(folder, units)
        result = subprocess.run([PROGRAM, "run", str(path), "--output", str(folder / "run")], capture_output=True, text=True, timeout=300)
        summary = folder / "run" / "summary.json"
        if result.returncode != 0 or not summary.exists():
            raise AssertionError(f"{self.name}, {units.name}: exit code {result.returncode}\n{result.stdout[-2000:]}{result.stderr[-500:]}")
        found = json.loads(summary.read_text())
        unit = units.energy * (math.sqrt(units.time) if self.step else 1)
        counts = {key: found[key] for key in ("newton_iterations", "newton_finest", "active_points", "cells")}
        energies = {key: found[key] / unit for key in ("energy_error", "energy_norm") if found.get(key) is not None}
        energies.update({"bound " + part: value / unit for part, value in found["estimate"].items() if isinstance(value, float)})
        with h5py.File(folder / "run" / "fields.h5") as fields:
            sets = {frame: fields[frame]["active"][()].tolist() for frame in fields if frame.startswith("fields")}
        return counts, sets, energies


def discontinuous(name, method, **more):
    """Case 'discontinuous multiplier'."""
    radius = 1 / 3
    R = repr(radius)
    w = f"(rho*rho - {R}*{R})"
    functions = {
        "mu1": ("tension", "1"), "mu2": ("tension", "1"),
        "f1": ("force", f"rho < {R} ? -8*{R}*{R} : 8*{R}*{R} - 16*rho*rho"),
        "f2": ("force", f"rho < {R} ? 8*{R}*{R} : 0"),
        "u1": ("height", f"rho < {R} ? 0 : {w}*{w}"), "u2": ("height", "0"),
        "lambda": ("force", f"rho < {R} ? 8*{R}*{R} : 0"),
        "u1_x": ("slope", f"rho < {R} ? 0 : 4*{w}*(X-0.5)"), "u1_y": ("slope", f"rho < {R} ? 0 : 4*{w}*(Y-0.5)"),
        "u2_x": ("slope", "0"), "u2_y": ("slope", "0"),
    }
    mesh = {"generator": "criss-cross", "cells per side": 4, "refinements": 1}
    return Deck(name, "membranes", functions, method, mesh, interface=f"rho - {R}", **more)


def smooth():
    """Case 'smooth contact'."""
    R = repr(1 / 3)
    w = f"(rho*rho - {R}*{R})"
    lam = f"1000*rho^3*({R}*{R} - rho*rho)^3"
    f1 = f"(rho < {R} ? -{lam} : -24*{w}^4*(6*rho*rho - {R}*{R}))"
    u1 = f"(rho < {R} ? 0 : {w}^6)"
    slope = f"(rho < {R} ? 0 : 12*{w}^5)"
    functions = {
        "mu1": ("tension", "1"), "mu2": ("tension", "1"), "f1": ("force", f1), "f2": ("force", "-" + f1),
        "u1": ("height", u1), "u2": ("height", "-" + u1), "lambda": ("force", f"rho < {R} ? {lam} : 0"),
        "u1_x": ("slope", f"{slope}*(X-0.5)"), "u1_y": ("slope", f"{slope}*(Y-0.5)"),
        "u2_x": ("slope", f"-{slope}*(X-0.5)"), "u2_y": ("slope", f"-{slope}*(Y-0.5)"),
    }
    mesh = {"generator": "criss-cross", "cells per side": 4, "refinements": 1}
    return Deck("smooth contact, fem 4", "membranes", functions, {"name": "fem", "degree": 4}, mesh, interface=f"rho - {R}", gap=7e-3)


def radial():
    """As case 'radial obstacle', with the membrane leaving at R = 0.3, on the square."""
    R = 0.3
    B = -2 * R * R
    A = 0.5 - R * R - B * math.log(R)
    functions = {
        "mu": ("tension", "1"), "f": ("force", "0"), "psi": ("height", "0.5 - rho*rho"),
        "u": ("height", f"rho < {R!r} ? 0.5 - rho*rho : {A!r} + {B!r}*log(rho + 1e-300)"), "lambda": ("force", f"rho < {R!r} ? 4 : 0"),
        "u_x": ("slope", f"(rho < {R!r} ? -2 : {B!r}/(rho*rho))*(X-0.5)"), "u_y": ("slope", f"(rho < {R!r} ? -2 : {B!r}/(rho*rho))*(Y-0.5)"),
    }
    mesh = {"generator": "criss-cross", "cells per side": 4, "refinements": 2}
    return Deck("radial obstacle", "obstacle", functions, {"name": "fem", "degree": 1}, mesh, interface=f"rho - {R!r}")


def moving():
    """Case 'moving contact'."""
    mu, v0 = (1, 0.5), 0.5
    kappa = mu[0] * mu[1] / (mu[0] + mu[1])
    pi = repr(math.pi)
    R = f"(0.25 + 0.1*sin(2*{pi}*TIME))"
    z = f"((X-0.5)^2 + (Y-0.5)^2 - {R}*{R})"
    open_ = f"({z} > 0 ? 1 : 0)"
    shape = f"sin({pi}*X)*sin({pi}*Y)"
    lam = f"({z} > 0 ? 0 : {80 / 3!r}*{R}*{R} - 10*{z})"
    functions = {}
    for alpha in (0, 1):
        share = (1, -1)[alpha] * mu[1 - alpha] / (mu[0] + mu[1])
        push = (1, -1)[alpha]
        i = str(alpha + 1)
        functions["mu" + i] = ("tension", repr(mu[alpha]))
        functions["u" + i] = ("height", f"{v0}*cos(2*TIME)*{shape} + ({share!r})*{open_}*10*{z}*{z}")
        for d, (X, along) in enumerate((("X", f"cos({pi}*X)*sin({pi}*Y)"), ("Y", f"sin({pi}*X)*cos({pi}*Y)"))):
            functions[f"u{i}_{'xy'[d]}"] = (
                "slope", f"{v0}*cos(2*TIME)*{pi}*{along} + ({share!r})*{open_}*40*{z}*({X}-0.5)")
        rate = f"-2*{R}*0.2*{pi}*cos(2*{pi}*TIME)*20*{z}"
        laplace = f"4*(({z} + {R}*{R})*20 + 20*{z})"
        functions["f" + i] = (
            "force", f"{v0}*{shape}*(-2*sin(2*TIME) + {2 * mu[alpha]!r}*{pi}*{pi}*cos(2*TIME)) - ({push})*{lam}"
            f" + {open_}*(({share!r})*{rate} - ({push * kappa!r})*{laplace})")
    mesh = {"generator": "rectangle", "cells per side": 8}
    return Deck("moving contact", "parabolic membranes", functions, {"name": "fem", "degree": 1}, mesh, step=1 / 8, end=0.5)


DECKS = {
    "smooth": smooth(),
    "hho": discontinuous("discontinuous multiplier, hho 2", {"name": "hho", "degree": 2}),
    "sipg": discontinuous("discontinuous multiplier, sipg 2", {"name": "dg", "degree": 2, "variant": "sipg"}),
    "radial": radial(),
    "moving": moving(),
    "target": discontinuous("target", {"name": "fem", "degree": 1}, target=5e-2),
}
METHODS = os.environ.get("THIXIS_METHODS", "fem,dg,hho,fv").split(",")  # those that the program has
for name, method in (("hho", "hho"), ("sipg", "dg")):
    if method not in METHODS:
        del DECKS[name]



class Invariance(unittest.TestCase):
    def agree(self, deck, systems, digits):
        counts, sets, energies = deck.run(ONE)
        self.assertGreater(energies["energy_error"], 0)
        self.assertGreater(counts["active_points"], 0)
        for units in systems:
            with self.subTest(units=units.name):
                found_counts, found_sets, found = deck.run(units)
                # Newton starts at the held height that is closest to zero, which is another one where all heights are shifted
                of_the_start = ("newton_iterations", "newton_finest") if units.shift else ()
                for key in counts.keys() - set(of_the_start):
                    self.assertEqual(found_counts[key], counts[key], key)
                self.assertEqual(found_sets, sets)
                for key, value in energies.items():
                    if abs(value) <= 1e-6 * energies["energy_error"]:  # parts that are round-off
                        continue
                    known = deck.rounding(units) if key.startswith("bound") else 0
                    self.assertLessEqual(abs(found[key] - value), digits * abs(value) + known, key)


def add(name, deck):
    def units(self):
        self.agree(deck, SYSTEMS, 1e-7)

    def heights(self):
        self.agree(deck, (Units("raised", shift=1e6), Units("lowered", shift=-1e6)), 1e-6)

    setattr(Invariance, f"test_{name}_in_other_units", units)
    setattr(Invariance, f"test_{name}_at_other_heights", heights)


for name, deck in DECKS.items():
    add(name, deck)

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
