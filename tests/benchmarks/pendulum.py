"""The flexible pendulum of benchmarks."""

from funicular import Material, Rectangle, Scene


def pendulum(elements: int, youngs_modulus: float, density: float) -> Scene:
    """Return a cable "wire" of 1 m, pinned at one end and released from the horizontal; Pa, kg/m³."""
    scene = Scene()
    scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element="cable12", strain="engineering",
                section=Rectangle(height=0.02, width=0.02),
                material=Material(youngs_modulus=youngs_modulus, poisson_ratio=0.0, density=density))
    scene.pin("wire", s=0.0)
    return scene
