#pragma once

#include "core/cuda/event.hpp"
#include "core/cuda/stream.hpp"

namespace roadstereo::cuda {

/// A second stream for work that may run beside what a stream does meanwhile.
class Branch {
 public:
  Branch() = default;
  /// Nothing of it is in flight when memory goes that it uses.
  ~Branch() { settle(); }
  Branch(const Branch&) = delete;
  Branch& operator=(const Branch&) = delete;

  /// Where to enqueue such work, which begins when what `stream` has so far has ended. Kernels that are timed one by
  /// one do not run beside each other: it is `stream` then.
  StreamView fork(const StreamView& stream) {
    forked_ = stream.recorder() == nullptr;
    if (!forked_) return stream;
    before_.record(stream.get());
    ROADSTEREO_CUDA(cudaStreamWaitEvent(own_.get(), before_.get(), 0));
    return {own_.get(), nullptr, stream.programmatic()};
  }
  /// What `stream` gets from now on begins when that work has ended.
  void join(const StreamView& stream) {
    if (!forked_) return;
    after_.record(own_.get());
    ROADSTEREO_CUDA(cudaStreamWaitEvent(stream.get(), after_.get(), 0));
  }
  /// Waits for it where nobody can be told of an error.
  void settle() const noexcept { StreamView(own_.get()).settle(); }

 private:
  Stream own_;
  Event before_{cudaEventDisableTiming}, after_{cudaEventDisableTiming};
  bool forked_ = false;
};

}  // namespace roadstereo::cuda
