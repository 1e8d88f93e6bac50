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

class ArgumentError(PhotonLoupeError, ValueError):
    pass

class SceneError(PhotonLoupeError):
    pass

class DeviceError(PhotonLoupeError):
    pass

class DeviceMemoryError(PhotonLoupeError):
    pass

class Cancelled(PhotonLoupeError):
    pass

def describe_settings(stage: str) -> list:
    """
    Every setting of trace, relax, irradiance, render or loupe: name, kind, default, range …
    """

def choose_k(photons: PhotonMap | None) -> int:
    """How many photons an estimate gathers of a map where nothing is said."""

def list_devices() -> list:
    """Every Vulkan device of this machine."""

class Device:
    def __init__(self, selector: str = 'auto') -> None: ...

    @property
    def info(self) -> dict: ...

    def self_test(self) -> dict: ...

    def forget(self) -> None:
        """All stages run again, whatever they are asked."""

    def timings(self) -> list: ...

class Scene:
    @property
    def path(self) -> str: ...

    @property
    def hash(self) -> str: ...

    @property
    def origin(self) -> list[float]: ...

    @property
    def additions(self) -> list[str]: ...

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

def add_to_scene(scene: Scene, addition: str) -> Scene:
    """
    A copy with a light or a floor more; addition as engine/scene/edit_scene.h has it.
    """

def load_scene(path: str) -> Scene:
    """Read a glTF scene (.gltf or .glb)."""

class PhotonMap:
    @property
    def count(self) -> int: ...

    @property
    def emitted(self) -> int: ...

    @property
    def report(self) -> dict: ...

    @property
    def axes(self) -> list[tuple[str, float, float, float]]:
        """
        Of the parameters: name, low, high, and a period, 0 where it does not wrap.
        """

    def tree(self, device: Device) -> dict: ...

    @property
    def names(self) -> list[str]:
        """Of the columns there are."""

    def column(self, name: str) -> object:
        """The column, read-only; None: there is none."""

def photons_from_columns(device: Device, columns: dict, axes: Sequence[tuple[str, float, float, float]], origin: dict, emitted: int) -> PhotonMap:
    """
    Upload checked columns as a photon map; axes as of its parameters, origin: store and emission where they are known.
    """

def share_photons(device: Device, photons: PhotonMap) -> PhotonMap:
    """The same photons in the same memory, with parameters of their own."""

def select_photons(device: Device, photons: PhotonMap, ids: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', writable=False)]) -> PhotonMap:
    """Some photons, all columns."""

def find_signature(photons: PhotonMap, interactions: Sequence[int]) -> NDArray[numpy.uint32]:
    """
    Ids of the photons whose paths, which the map must have, went through just these.
    """

def find_neighbors(device: Device, photons: PhotonMap, points: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', writable=False)] | None, ids: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', writable=False)] | None, k: int, query: dict, progress: object | None = None) -> tuple:
    """
    The k nearest photons of points, or of photons by id (n,); exactly one is not None. query: space, beta, center, low, high.
    """

def set_parameters(device: Device, photons: PhotonMap, values: Annotated[NDArray[numpy.float32], dict(shape=(None, None), order='C', writable=False)], axes: Sequence[tuple[str, float, float, float]]) -> None:
    """Replace a map's parameters (n, m)."""

def trace_photons(device: Device, scene: Scene, settings: dict, progress: object | None = None) -> PhotonMap:
    """
    Trace photons; settings as describe_settings("trace") has them, and paths.
    """

def record_paths(device: Device, photons: PhotonMap, scene: Scene, settings: dict, progress: object | None = None) -> None:
    """Give traced photons their paths, by tracing them again."""

class Script:
    def __init__(self, text: bytes, name: str) -> None: ...

    @property
    def hash(self) -> str: ...

    @property
    def diagnostics(self) -> list: ...

    @property
    def exposed(self) -> list: ...

    @property
    def columns(self) -> list[str]: ...

    @property
    def passes(self) -> list: ...

    def glsl(self) -> list:
        """The text of every compute pass."""

    def spirv(self) -> list:
        """Every compute pass as SPIR-V."""

    def run(self, device: Device, photons: PhotonMap, settings: dict, progress: object | None = None) -> dict:
        """
        Run over a map; settings: values, keep, seed, fuel, exhausted, seconds.
        """

def list_script_builtins() -> list:
    """Every predefined call: name, signature, group, doc."""

def list_script_codes() -> list:
    """Every diagnostic code with its meaning."""

class Relaxation:
    def step(self, progress: object | None = None) -> dict:
        """One step; what it did."""

    @property
    def settings(self) -> dict:
        """All of them, what is automatic filled in."""

    @property
    def notes(self) -> list[str]:
        """What makes parameters useless here, with the cure."""

    @property
    def off_surface(self) -> int:
        """Photons that moved in their tangent plane."""

    def read(self) -> PhotonMap:
        """The map as it is now."""

def find_optimal_beta(device: Device, photons: PhotonMap, k: int, clip: float, progress: object | None = None) -> tuple[float, float, NDArray[numpy.float32]] | None:
    """
    β, t_β and the axis ratios (n,) they come from; None: no photon has one.
    """

def explain_no_ratio(photons: PhotonMap) -> str:
    """Why β cannot be found, and what to do."""

def relax_photons(device: Device, photons: PhotonMap, scene: object | None, settings: dict, progress: object | None = None) -> tuple:
    """
    All steps of a relaxation: the map, and settings, steps, notes, off_surface; settings as start_relaxation.
    """

def start_relaxation(device: Device, photons: PhotonMap, scene: object | None, settings: dict, progress: object | None = None) -> Relaxation:
    """
    Measure the constraint and stand ready; settings as describe_settings("relax") has them.
    """

def aim_camera(position: Sequence[float], target: Sequence[float], up: Sequence[float], yfov: float) -> dict:
    """A camera with its axes, that looks from one point at another."""

def estimate_irradiance(device: Device, photons: PhotonMap, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', writable=False)], normals: Annotated[NDArray[numpy.float32], dict(shape=(None, 3), order='C', writable=False)], settings: dict, progress: object | None = None) -> NDArray[numpy.float32]:
    """
    Irradiance (n, 3) in W/m² at points with unit normals; settings as describe_settings("irradiance") has them.
    """

def estimate_fluence(device: Device, photons: PhotonMap, scene: Scene, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', writable=False)], settings: dict, progress: object | None = None) -> NDArray[numpy.float32]:
    """
    Fluence (n, 3) in W/m² at points in media; settings as describe_settings("irradiance") has them.
    """

def render_image(device: Device, scene: Scene, photons: object | None, settings: dict, progress: object | None = None) -> Annotated[NDArray[numpy.float32], dict(shape=(None, None, None))]:
    """
    Linear radiance (height, width, 3); settings as describe_settings("render") has them, and camera.
    """

def write_file(path: str, content: bytes) -> None:
    """
    Write a file so that a killed program leaves the old one or the new one.
    """

def write_exr(path: str, pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], attributes: Mapping[str, str]) -> None: ...

def read_exr(path: str) -> tuple: ...

def write_png(path: str, pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], exposure: float, attributes: Mapping[str, str]) -> None: ...

def encode_png(pixels: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], exposure: float, attributes: Mapping[str, str]) -> bytes: ...

def read_png(path: str) -> tuple: ...

def list_columns(photons: PhotonMap) -> list:
    """
    Every column a view can plot: name, label, period, discrete, needs_paths, missing.
    """

def find_column(device: Device, photons: PhotonMap, name: str, progress: object | None = None) -> dict:
    """One column: name, label, values (n,), low, high, period, discrete."""

def count_column(values: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', writable=False)], bins: int, range: tuple[float, float] | None, bounds: tuple[float, float]) -> dict:
    """
    Histogram of values (n,): counts, edges, cdf, below, above, non_finite; bounds stand in for no range.
    """

def find_quantile(values: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', writable=False)], share: float) -> float:
    """The value that a share of the finite ones lie below."""

def look_through_loupe(device: Device, photons: PhotonMap, query: dict, progress: object | None = None) -> dict:
    """
    What a loupe shows; query: point, normal, photon, k, space, beta, center, low, high.
    """

def read_path_lines(photons: PhotonMap, ids: Sequence[int]) -> list:
    """(vertices (m, 3), interactions (m,)) of each photon's path."""

def measure_spectrum(device: Device, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', writable=False)], radius: Sequence[float], progress: object | None = None) -> tuple:
    """
    Frequencies (m, 2) of a half plane up to `radius` cycles over the sides, and the power (m,) of points (n, 2) in sides.
    """

def see_surfaces(device: Device, scene: Scene, settings: dict, progress: object | None = None) -> tuple:
    """
    (points and depth (p, 4), normals (p, 3), objects (p,)) by pixel; settings: camera, width, height, through_glass.
    """

def find_voronoi_cells(device: Device, photons: PhotonMap, scene: Scene, settings: dict, progress: object | None = None) -> dict:
    """
    ids, depth, borders (h, w), pixels (h, w, 3); settings: camera, width, height, through_glass, flatness, color.
    """

def find_kd_cells(device: Device, photons: PhotonMap, scene: Scene, settings: dict, progress: object | None = None) -> dict:
    """
    The same with nodes for ids, and boxes (node, photons, corners); settings: camera, width, height, through_glass, depth.
    """

def plot_scatter(device: Device, photons: PhotonMap, settings: dict, selection: Sequence[int] | None) -> dict:
    """
    A scatter plot; settings: x, y, width, height, polar, color, x_range, y_range, dense_from.
    """

def map_errors(image: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], reference: Annotated[NDArray[numpy.float32], dict(shape=(None, None, 3), order='C', writable=False)], relative: bool, full: float) -> dict:
    """
    Errors by pixel: pixels (h, w, 3), absolute, relative (h, w), rmse, relmse.
    """

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
    Axes: name, label, values, low, high, period, discrete, flipped, closed, periods, brush each. Settings: size, tension, density, most_curves.
    """

class Studio:
    def frame(self) -> None: ...

    def wait(self, arg: float, /) -> bool: ...

    def hide(self) -> None: ...

    @property
    def should_close(self) -> bool: ...

    @property
    def size(self) -> tuple[int, int]: ...

    def image(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None, None, None))]: ...

    def panel(self, arg0: str, arg1: int, arg2: int, arg3: float, /) -> Annotated[NDArray[numpy.uint8], dict(shape=(None, None, None))]: ...

    def resize(self, arg0: int, arg1: int, /) -> None: ...

    def statistics(self) -> dict: ...

    def move_mouse(self, arg0: float, arg1: float, /) -> None: ...

    def press_mouse(self, arg0: int, arg1: bool, /) -> None: ...

    def turn_wheel(self, arg: float, /) -> None: ...

    def press_key(self, arg: str, /) -> None: ...

    def hold_key(self, arg0: str, arg1: bool, /) -> None: ...

    def type_text(self, arg: str, /) -> None: ...

    def drop_file(self, arg: str, /) -> None: ...

    def command(self, arg: str, /) -> None: ...

    def widget(self, arg: str, /) -> list[float] | None: ...

    def widgets(self) -> list[str]: ...

    def take_turn(self) -> bool:
        """
        Begin the next job; True: it has been done, and a frame should show it.
        """

    @property
    def is_busy(self) -> bool: ...

    @property
    def job_counts(self) -> dict[str, int]:
        """Jobs begun, by kind."""

    def close(self) -> None: ...

    def stop_job(self) -> None: ...

    def open_scene(self, arg: Scene, /) -> None: ...

    def made(self) -> dict:
        """
        scene, photons, trace (settings; None: from a file), origin (what load_map gave), script, relaxed, relaxation; None where there is none.
        """

    def rendered(self) -> tuple[Annotated[NDArray[numpy.float32], dict(shape=(None, None, None))], dict, bool] | None:
        """
        The last rendered view, its settings, and whether its photons are relaxed.
        """

    def take_requests(self) -> list[str]: ...

    def say(self, arg0: str, arg1: bool, /) -> None: ...

    def forget_work(self, arg: str, /) -> None: ...

    def offer_restore(self, arg: str, /) -> None: ...

    def deliver_examples(self, arg: Sequence[tuple[str, str]], /) -> None: ...

    def state(self) -> str: ...

    def set_state(self, arg0: str, arg1: str, /) -> None: ...

    def save_session(self, arg: str, /) -> None: ...

    def load_session(self, arg: str, /) -> None: ...

    def python(self) -> str: ...

    def complete_state(self) -> str: ...

    def message(self) -> tuple[str, bool]: ...

    def look_at(self, arg: Sequence[float], /) -> None: ...

    def loupe_ids(self) -> NDArray[numpy.uint32]: ...

    def paths(self) -> tuple[str, str]:
        """Scene and script; empty: none."""

    def has_relaxed(self) -> bool: ...

    def version(self) -> int: ...

    def selection(self) -> object: ...

    def select(self, ids: Sequence[int] | None) -> None: ...

def open_studio(device: Device, size: tuple[int, int], scale: float, offscreen: bool, threaded: bool, load_map: object, compare: object) -> Studio:
    """
    The interactive tool, in a window or without, that works in a thread or in its frames. load_map(path): what is kept of it, the map, its scene or None, remarks. compare(pixels, path): reference, error map or None, rmse, relmse, flip, and why there is none.
    """

def find_cache_folder() -> str:
    """The per-user folder for what can be made again; empty: there is none."""

def list_studio_commands() -> list: ...
