#pragma once

#include <dlpack/dlpack.h>
#include <pybind11/pybind11.h>

#include <memory>

namespace roadstereo::python {

/// A map in the memory of a device: rows without padding.
struct DeviceMap {
  const void* data;
  DLDataType type;
  int width, height;  ///< pixels
  DLDevice device;
  std::shared_ptr<const void> owner;  ///< keeps the memory
};

/// Returns the capsule "dltensor" of the map, which keeps its owner: until the consumer calls the deleter, in any
/// thread, or until the capsule goes without having been consumed.
pybind11::capsule dlpack_capsule(const DeviceMap& map);

}  // namespace roadstereo::python
