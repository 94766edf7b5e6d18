"""Maps in the memory of a device, handed out by DLPack: what a consumer sees in a capsule, and how long it lasts.

Emulated kernels work in the host's memory, where numpy can read the maps.
"""

import ctypes
import gc
import threading
import unittest

import numpy as np
from rendered_road import calibration, noise_pair, pair

import roadstereo

CPU, CUDA = 1, 2  # DLDeviceType
MAPS = {"disparity": (2, 32), "sigma": (2, 32), "transformed": (2, 32), "grey": (0, 16)}  # DLDataTypeCode, bits


class Tensor(ctypes.Structure):
    """DLManagedTensor of dlpack.h, version 0.6."""


DELETER = ctypes.CFUNCTYPE(None, ctypes.POINTER(Tensor))
Tensor._fields_ = [
    ("data", ctypes.c_void_p),
    ("device_type", ctypes.c_int32),
    ("device_id", ctypes.c_int32),
    ("ndim", ctypes.c_int32),
    ("code", ctypes.c_uint8),
    ("bits", ctypes.c_uint8),
    ("lanes", ctypes.c_uint16),
    ("shape", ctypes.POINTER(ctypes.c_int64)),
    ("strides", ctypes.POINTER(ctypes.c_int64)),
    ("byte_offset", ctypes.c_uint64),
    ("manager_ctx", ctypes.c_void_p),
    ("deleter", DELETER),
]

pointer_of = ctypes.pythonapi.PyCapsule_GetPointer
pointer_of.restype, pointer_of.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
rename = ctypes.pythonapi.PyCapsule_SetName
rename.argtypes = [ctypes.py_object, ctypes.c_char_p]
USED = ctypes.c_char_p(b"used_dltensor")  # a capsule does not copy its name


def tensor_in(capsule):
    return Tensor.from_address(pointer_of(capsule, b"dltensor"))


def place_of(device_map):
    """The address of the first pixel."""
    capsule = device_map.__dlpack__()  # which has the tensor
    return tensor_in(capsule).data


class Once:
    """Hands out one capsule, again and again."""

    def __init__(self, device_map):
        self.capsule, self.device = device_map.__dlpack__(), device_map.__dlpack_device__()

    def __dlpack__(self, **_):
        return self.capsule

    def __dlpack_device__(self):
        return self.device


MISSING = None if "cuda" in roadstereo.engine_names() else "there is no GPU, nor are kernels emulated"


@unittest.skipIf(MISSING is not None, MISSING)
class DeviceMaps(unittest.TestCase):
    def setUp(self):
        self.pipeline = roadstereo.Pipeline("fast", calibration(), engine="cuda")
        self.result = self.pipeline.process(*pair())
        self.maps = self.pipeline.device_maps()
        self.device = self.maps.disparity.__dlpack_device__()

    def next_pair(self):
        self.pipeline.process(*noise_pair())

    def on_host(self):
        if self.device[0] != CPU:
            self.skipTest("numpy does not read the memory of a GPU")

    def test_capsule_describes_map(self):
        self.assertIn(self.device, {(CPU, 0), (CUDA, 0)})
        for name, kind in MAPS.items():
            device_map = getattr(self.maps, name)
            tensor = tensor_in(capsule := device_map.__dlpack__())
            self.assertEqual(device_map.shape, (180, 320), name)
            self.assertEqual((tensor.ndim, tensor.shape[:2], tensor.strides[:2]), (2, [180, 320], [320, 1]), name)
            self.assertEqual((tensor.code, tensor.bits, tensor.lanes), (*kind, 1), name)
            self.assertEqual((tensor.device_type, tensor.device_id), device_map.__dlpack_device__(), name)
            self.assertEqual(tensor.byte_offset, 0, name)
            del capsule

    def test_numpy_reads_maps(self):
        self.on_host()
        for name in MAPS:
            read, copied = np.from_dlpack(getattr(self.maps, name)), getattr(self.result, name)
            self.assertEqual((read.dtype, read.shape), (copied.dtype, copied.shape), name)
            self.assertEqual(read.tobytes(), copied.tobytes(), name)

    def test_tensor_outlives_map_and_pipeline(self):
        self.on_host()
        read, expected = np.from_dlpack(self.maps.disparity), self.result.disparity.tobytes()
        del self.maps
        for _ in range(3):
            self.next_pair()
        self.assertEqual(read.tobytes(), expected)
        del self.pipeline
        gc.collect()
        self.assertEqual(read.tobytes(), expected)

    def test_deleter_releases_memory(self):
        place = place_of(self.maps.disparity)
        capsule = self.maps.disparity.__dlpack__()
        tensor = tensor_in(capsule)
        rename(capsule, USED)  # consumed
        del self.maps, capsule
        self.next_pair()
        self.assertNotEqual(place_of(self.pipeline.device_maps().disparity), place)
        thread = threading.Thread(target=lambda: tensor.deleter(ctypes.byref(tensor)))  # without the interpreter's lock
        thread.start()
        thread.join()
        self.next_pair()
        self.assertEqual(place_of(self.pipeline.device_maps().disparity), place)

    def test_capsule_that_nobody_consumes_releases_memory(self):
        place, capsule = place_of(self.maps.disparity), self.maps.disparity.__dlpack__()
        del self.maps
        self.next_pair()
        self.assertNotEqual(place_of(self.pipeline.device_maps().disparity), place)
        del capsule
        self.next_pair()
        self.assertEqual(place_of(self.pipeline.device_maps().disparity), place)

    def test_capsule_is_consumed_once(self):
        self.on_host()
        once = Once(self.maps.sigma)
        read = np.from_dlpack(once)
        with self.assertRaises(ValueError):
            np.from_dlpack(once)
        del once
        self.assertEqual(read.tobytes(), self.result.sigma.tobytes())

    def test_arguments(self):
        device_map = self.maps.grey
        for arguments in ({"stream": 1}, {"max_version": (1, 1)}, {"dl_device": self.device}, {"copy": False}):
            capsule = device_map.__dlpack__(**arguments)
            self.assertEqual(tensor_in(capsule).ndim, 2)
        with self.assertRaisesRegex(BufferError, "own device"):
            device_map.__dlpack__(dl_device=(CUDA, 7))
        with self.assertRaisesRegex(BufferError, "without a copy"):
            device_map.__dlpack__(copy=True)
        with self.assertRaises(TypeError):
            device_map.__dlpack__(1)

    def test_maps_stay_on_device(self):
        self.pipeline.set_device_options(download=False)
        result = self.pipeline.process(*pair())
        self.assertEqual((result.disparity.size, result.grey.size), (0, 0))
        self.assertEqual(self.pipeline.device_maps().disparity.shape, (180, 320))
        with self.assertRaisesRegex(roadstereo.Error, "left on the device"):
            roadstereo.find_damage(result)
        with self.assertRaisesRegex(roadstereo.Error, "map: the maps of the result were left on the device"):
            roadstereo.RoadMap(cell_m=0.02).add(result, np.eye(4))
        self.pipeline.set_device_options()
        self.assertEqual(self.pipeline.process(*pair()).disparity.shape, (180, 320))

    def test_no_maps_without_pair(self):
        pipeline = roadstereo.Pipeline("fast", engine="cuda")
        with self.assertRaisesRegex(roadstereo.Error, "no frame was processed yet"):
            pipeline.device_maps()
        with self.assertRaises(roadstereo.Error):
            self.pipeline.process(pair()[0], pair()[0])
        with self.assertRaisesRegex(roadstereo.Error, "the last one was refused"):
            self.pipeline.device_maps()


if __name__ == "__main__":
    if MISSING is not None:
        print(MISSING)  # which CTest takes for skipped
    unittest.main()
