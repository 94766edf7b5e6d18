#pragma once

#include <pybind11/pybind11.h>

#include <mutex>
#include <type_traits>

namespace roadstereo::python {

/// Calls of any thread that wait for each other, without the interpreter's lock.
class SerialCalls {
 public:
  template <class Function>
  std::invoke_result_t<Function> operator()(Function function) {
    const pybind11::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    return function();
  }

 private:
  std::mutex mutex_;
};

}  // namespace roadstereo::python
