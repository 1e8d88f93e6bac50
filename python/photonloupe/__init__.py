# SPDX-License-Identifier: Apache-2.0
"""Photon Loupe: photon mapping as data — load, trace, render, inspect, save.

Lengths are metres, irradiance W/m², radiance W/(m²·sr); axes are glTF's (y up).

Examples
--------
>>> import photonloupe as pl
>>> scene = pl.load_scene("scenes/ring/ring.gltf")
>>> photons = pl.trace_photons(scene, count=20_000, seed=1)
>>> pl.render(scene, photons, camera="top", width=64, height=64).save("ring.exr")
"""

from photonloupe import inspect
from photonloupe._engine import version as __version__
from photonloupe.blue_noise import BlueNoise, measure_blue_noise
from photonloupe.camera import Camera
from photonloupe.device import Device, devices
from photonloupe.errors import (
    ArgumentError,
    Cancelled,
    DeviceError,
    DeviceMemoryError,
    FileFormatError,
    PhotonLoupeError,
    SceneError,
    ScriptError,
)
from photonloupe.image import Image, load_image
from photonloupe.isotropy import Isotropy, OptimalBeta, optimal_beta
from photonloupe.kernels import use_kernels_in_place
from photonloupe.loading import load_photons
from photonloupe.metrics import ImageDifference, compare_images
from photonloupe.photons import PhotonMap
from photonloupe.relaxing import Relaxation
from photonloupe.rendering import render
from photonloupe.scene import Scene, load_scene
from photonloupe.scripting import Diagnostic, ExposedVariable, Histogram, Script, ScriptRun, compile_script
from photonloupe.studio import Studio
from photonloupe.tracing import trace_photons
from photonloupe.trajectory import find_primal_trajectory

use_kernels_in_place()

__all__ = [
    "ArgumentError",
    "BlueNoise",
    "Camera",
    "Cancelled",
    "Device",
    "DeviceError",
    "DeviceMemoryError",
    "Diagnostic",
    "ExposedVariable",
    "FileFormatError",
    "Histogram",
    "Image",
    "ImageDifference",
    "Isotropy",
    "OptimalBeta",
    "PhotonLoupeError",
    "PhotonMap",
    "Relaxation",
    "Scene",
    "SceneError",
    "Script",
    "ScriptError",
    "ScriptRun",
    "Studio",
    "__version__",
    "compare_images",
    "compile_script",
    "devices",
    "find_primal_trajectory",
    "inspect",
    "load_image",
    "load_photons",
    "load_scene",
    "measure_blue_noise",
    "optimal_beta",
    "render",
    "trace_photons",
]
