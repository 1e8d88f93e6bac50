"""
Photon Loupe's engine: tracing, photon maps, estimation on Vulkan compute.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray


version: str = '0.1.0'

class PhotonLoupeError(Exception):
    pass

class SceneError(PhotonLoupeError):
    pass

class DeviceError(PhotonLoupeError):
    pass

class DeviceMemoryError(PhotonLoupeError):
    pass

class Cancelled(PhotonLoupeError):
    pass

def list_devices() -> list:
    """Every Vulkan device of this machine."""

class Device:
    def __init__(self, selector: str = 'auto') -> None: ...

    @property
    def info(self) -> dict: ...

    def self_test(self) -> dict: ...

    def timings(self) -> list: ...

class Scene:
    @property
    def path(self) -> str: ...

    @property
    def hash(self) -> str: ...

    @property
    def origin(self) -> list[float]: ...

    @property
    def bounds(self) -> tuple: ...

    @property
    def cameras(self) -> list: ...

    @property
    def lights(self) -> list: ...

    @property
    def materials(self) -> list: ...

    @property
    def objects(self) -> list: ...

    @property
    def report(self) -> dict: ...

    @property
    def triangle_count(self) -> int: ...

    def describe(self) -> str: ...

def load_scene(path: str) -> Scene:
    """Read a glTF scene (.gltf or .glb)."""

class PhotonMap:
    @property
    def count(self) -> int: ...

    @property
    def emitted(self) -> int: ...

    @property
    def origin(self) -> list[float]: ...

    @property
    def report(self) -> dict: ...

    def tree(self, device: Device) -> dict: ...

    @property
    def positions(self) -> object: ...

    @property
    def normals(self) -> object: ...

    @property
    def power(self) -> object: ...

    @property
    def emitter(self) -> NDArray[numpy.int32]: ...

    @property
    def emitted_index(self) -> NDArray[numpy.uint64]: ...

    @property
    def object(self) -> NDArray[numpy.int32]: ...

    @property
    def path_vertices(self) -> object: ...

    @property
    def path_offsets(self) -> object: ...

    @property
    def path_normals(self) -> object: ...

    @property
    def path_interactions(self) -> object: ...

    @property
    def path_objects(self) -> object: ...

    @property
    def path_scatter(self) -> object: ...

def photons_from_columns(device: Device, columns: dict, store: str = 'caustic') -> PhotonMap:
    """Upload checked columns as a photon map."""

def find_neighbors(device: Device, photons: PhotonMap, points: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', writable=False)] | None, ids: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', writable=False)] | None, k: int, query: dict, progress: object | None = None) -> tuple:
    """
    The k nearest photons of points, or of photons by id (n,); exactly one is not None. query: space, beta, center, low, high.
    """

def set_parameters(device: Device, photons: PhotonMap, values: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', writable=False)], periods: Sequence[float]) -> None:
    """Replace a map's parameters (n, m); a period of 0: it does not wrap."""

def set_paths(device: Device, photons: PhotonMap, columns: dict) -> None:
    """Give a map the checked path columns of its photons."""

def set_colors(device: Device, photons: PhotonMap, values: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', writable=False)]) -> None:
    """Replace a map's false colors (n, 3); NaN: none, shown in grey."""

def trace_photons(device: Device, scene: Scene, settings: dict, progress: object | None = None) -> PhotonMap:
    """
    Trace photons; settings: count, emitted, seed, emission, store, max_bounces, paths.
    """

class Script:
    def __init__(self, text: bytes, name: str) -> None: ...

    @property
    def hash(self) -> str: ...

    @property
    def diagnostics(self) -> list: ...

    @property
    def exposed(self) -> list: ...

    @property
    def columns(self) -> list: ...

    @property
    def passes(self) -> list: ...

    def glsl(self) -> list:
        """The text of every compute pass."""

    def spirv(self) -> list:
        """Every compute pass as SPIR-V."""

    def run(self, device: Device, photons: PhotonMap, settings: dict, progress: object | None = None) -> dict:
        """
        Run over a map; settings: values, keep, seed, fuel, exhausted, seconds, and what keep keeps: parameters, old_values, old_colors.
        """

def list_script_builtins() -> list:
    """Every predefined call: name, signature, group, doc."""

def list_script_codes() -> list:
    """Every diagnostic code with its meaning."""

class Relaxation:
    def step(self, progress: object | None = None) -> dict:
        """One step; what it did."""

    def read(self) -> tuple:
        """(map, state columns by photon id, photons off their surface)."""

def measure_isotropy(device: Device, photons: PhotonMap, k: int, progress: object | None = None) -> NDArray[numpy.float32]:
    """
    Axis ratios (n,) of the world positions of each photon's k neighbours in parameter space; NaN: none.
    """

def measure_spectrum(device: Device, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', writable=False)], radius: Sequence[float], progress: object | None = None) -> tuple:
    """
    Frequencies (m, 2) of a half plane up to `radius` cycles over the sides, and the power (m,) of points (n, 2) in sides.
    """

def start_relaxation(device: Device, photons: PhotonMap, scene: object | None, settings: dict, progress: object | None = None) -> Relaxation:
    """
    Measure the constraint and stand ready; settings: steps, neighbors, over_relaxation, limit, repel, beta, search, tree, diffuse_flux, period, descriptor, constraint, constraint_neighbors, thresholds.
    """

def estimate_irradiance(device: Device, photons: PhotonMap, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', writable=False)], normals: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', writable=False)], k: int, kernel: str, progress: object | None = None) -> NDArray[numpy.float32]:
    """Irradiance (n, 3) in W/m² at points with unit normals."""

def render_image(device: Device, scene: Scene, photons: object | None, settings: dict, progress: object | None = None) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, None))]:
    """
    Linear radiance (height, width, 3); settings: camera, width, height, samples, mode, k, kernel, seed.
    """

def write_exr(path: str, pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], attributes: Mapping[str, str]) -> None: ...

def read_exr(path: str) -> tuple: ...

def write_png(path: str, pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], exposure: float, attributes: Mapping[str, str]) -> None: ...

def encode_png(pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], exposure: float, attributes: Mapping[str, str]) -> bytes: ...

def read_png(path: str) -> tuple: ...

class ParallelFigure:
    def read_pixels(self) -> NDArray[numpy.uint8]:
        """RGBA (height · width, 4), sRGB."""

    @property
    def is_density(self) -> bool: ...

    def read_selected(self) -> tuple:
        """
        Of the photons in focus: ids (s,), points (s · axes, 2), tangents (s · gaps, 2), photons with a break.
        """

    def read_context(self) -> tuple:
        """The same of the others."""

    def read_densities(self) -> list:
        """
        Per axis: shares, heights, whether bars, bandwidth, what height 1 stands for.
        """

    def read_marks(self) -> list:
        """
        Per axis: (center x, center y, rx, ry), text above and below, outlines of density and brushes, ticks.
        """

    def write_svg(self, path: str) -> None: ...

def make_parallel_figure(device: Device, axes: list, focus: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', device='cpu', writable=False)], color: object | None, colors: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', writable=False)], settings: dict) -> ParallelFigure:
    """
    Axes: name, label, values, low, high, period, is_discrete, flipped, closed, periods, brush each. Settings: size, tension, density, most_curves.
    """
