#include "dlpack.hpp"

#include <array>
#include <cstdint>

namespace roadstereo::python {
namespace {

constexpr const char* unconsumed = "dltensor";  // a consumer renames the capsule

/// What a tensor points to.
struct Tensor {
  DLManagedTensor managed{};
  std::array<std::int64_t, 2> shape{}, strides{};
  std::shared_ptr<const void> owner;
};

void delete_tensor(DLManagedTensor* managed) {
  delete static_cast<Tensor*>(managed->manager_ctx);
}

void delete_unconsumed(PyObject* capsule) {
  if (PyCapsule_IsValid(capsule, unconsumed) == 0) return;
  delete_tensor(static_cast<DLManagedTensor*>(PyCapsule_GetPointer(capsule, unconsumed)));
}

}  // namespace

pybind11::capsule dlpack_capsule(const DeviceMap& map) {
  auto tensor = std::make_unique<Tensor>();
  tensor->shape = {map.height, map.width};
  tensor->strides = {map.width, 1};
  tensor->owner = map.owner;
  tensor->managed.dl_tensor = {const_cast<void*>(map.data), map.device, 2, map.type, tensor->shape.data(),
                               tensor->strides.data(),      0};
  tensor->managed.manager_ctx = tensor.get();
  tensor->managed.deleter = delete_tensor;
  const pybind11::capsule capsule(&tensor->managed, unconsumed, delete_unconsumed);
  static_cast<void>(tensor.release());
  return capsule;
}

}  // namespace roadstereo::python
