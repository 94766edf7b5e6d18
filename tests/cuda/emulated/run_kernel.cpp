#include "run_kernel.hpp"

#include <ucontext.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "threads.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(ROADSTEREO_EMULATED_RACES)
#include <sanitizer/tsan_interface.h>
#endif

namespace roadstereo::cuda::emulated {
namespace {

constexpr std::size_t stack_bytes = std::size_t{256} << 10;
constexpr int warp = 32;
constexpr unsigned char nothing_written = 0xFF;

enum class Waits { no, for_warp, for_block, ended };

/// What a lane leaves for the others, and in which of its exchanges.
struct Left {
  std::uint64_t bits = 0;
  unsigned exchange = 0;
};

/// Where threads meet, to the thread sanitizer: what each did before is ordered before what any does after. Two in
/// turn, so that whoever goes on first and comes to the next barrier does not hand that to those who still come from
/// this one.
struct Meeting {
  char at[2];
};

/// One way of execution that can be left and entered again. The scheduler's own has no stack of ours.
struct Fiber {
  ucontext_t context{};
  void* resume[5]{};
  bool started = false;
  std::unique_ptr<char[]> stack;
  Waits waits = Waits::no;
  Left left[2];                              ///< in two exchanges in turn, so that one barrier between them suffices
  unsigned exchanges = 0;                    ///< so far
  unsigned warp_waits = 0, block_waits = 0;  ///< of this block
  Meeting of_warp{};                         ///< of the warp whose first lane this is
  Here here{};
#if defined(__SANITIZE_ADDRESS__)
  void* fake_stack = nullptr;
#endif
#if defined(ROADSTEREO_EMULATED_RACES)
  void* of_sanitizer = nullptr;
#endif
};

/// The threads of the block that runs in this thread of the host.
struct Block {
  std::vector<std::unique_ptr<Fiber>> fibers;  ///< kept from launch to launch
  std::size_t threads = 0;
  Fiber scheduler;
  Fiber* running = nullptr;
  const std::function<void()>* kernel = nullptr;
  std::exception_ptr failure;
  Meeting meeting{};
  char begun = 0;
  std::vector<unsigned char> shared;  ///< of just the size, so that the address sanitizer sees its end
  std::size_t launches = 0;
  const void* stack_of_scheduler = nullptr;
  std::size_t stack_of_scheduler_bytes = 0;

  ~Block() { forget_fibers(); }
  void forget_fibers();
};

Block& block() {
  static thread_local Block own;
  return own;
}

/// What came before in this thread is ordered before what follows accept() in another. Threads of a kernel are threads
/// to the sanitizer, which nothing else orders: it sees a missing barrier as what it is, a race.
void offer([[maybe_unused]] void* at) {
#if defined(ROADSTEREO_EMULATED_RACES)
  __tsan_release(at);
#endif
}
void accept([[maybe_unused]] void* at) {
#if defined(ROADSTEREO_EMULATED_RACES)
  __tsan_acquire(at);
#endif
}

/// Not instrumented: the address sanitizer, which is told of the new stack, would ask the system for the signal stack
/// before the jump, and take two thirds of the time of all tests for that.
__attribute__((no_sanitize("address"))) void switch_fibers(Fiber& from, Fiber& to) {
#if defined(__SANITIZE_ADDRESS__)
  Block& own = block();
  const bool to_scheduler = &to == &own.scheduler;
  __sanitizer_start_switch_fiber(&from.fake_stack, to_scheduler ? own.stack_of_scheduler : to.stack.get(),
                                 to_scheduler ? own.stack_of_scheduler_bytes : stack_bytes);
#endif
#if defined(ROADSTEREO_EMULATED_RACES)
  // The scheduler knows of all that came before, and hands none of it on.
  __tsan_switch_to_fiber(to.of_sanitizer, &to == &block().scheduler ? 0 : __tsan_switch_to_fiber_no_sync);
#endif
  // Several times as fast as swapcontext, which asks the system for the signals each time.
  if (__builtin_setjmp(from.resume) == 0) {
    if (to.started) __builtin_longjmp(to.resume, 1);
    to.started = true;
    setcontext(&to.context);
  }
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_finish_switch_fiber(from.fake_stack, nullptr, nullptr);
#endif
}

void Block::forget_fibers() {
#if defined(ROADSTEREO_EMULATED_RACES)
  for (const auto& fiber : fibers) __tsan_destroy_fiber(fiber->of_sanitizer);
#endif
  fibers.clear();
}

/// A kernel that went wrong leaves threads in its middle, which must not go on.
template <class Failure>
[[noreturn]] void give_up(const Failure& fail) {
  Block& own = block();
  own.forget_fibers();
  fail();
  std::abort();
}

/// What a fiber does: one thread of a kernel after the other, and back to the scheduler in between.
void run_threads() {
  Block& own = block();
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_finish_switch_fiber(nullptr, &own.stack_of_scheduler, &own.stack_of_scheduler_bytes);
#endif
  for (;;) {
    Fiber& self = *own.running;
    accept(&own.begun);
    try {
      (*own.kernel)();
    } catch (...) {
      own.failure = std::current_exception();
    }
    self.waits = Waits::ended;
    switch_fibers(self, own.scheduler);
  }
}

std::unique_ptr<Fiber> make_fiber() {
  auto fiber = std::make_unique<Fiber>();
  fiber->stack.reset(new char[stack_bytes]);
#if defined(ROADSTEREO_EMULATED_RACES)
  fiber->of_sanitizer = __tsan_create_fiber(0);
#endif
  getcontext(&fiber->context);
  fiber->context.uc_stack.ss_sp = fiber->stack.get();
  fiber->context.uc_stack.ss_size = stack_bytes;
  fiber->context.uc_link = nullptr;
  makecontext(&fiber->context, run_threads, 0);
  return fiber;
}

/// Waits for the warp, whose memory is not ordered by that.
void wait_in_warp() {
  Block& own = block();
  Fiber& self = *own.running;
  self.waits = Waits::for_warp;
  switch_fibers(self, own.scheduler);
}

/// Lets go the warps, or else the block, all of whose threads wait for it. True when somebody can run.
bool release_waiting() {
  Block& own = block();
  bool released = false;
  for (std::size_t first = 0; first < own.threads; first += warp) {
    const std::size_t end = std::min(first + warp, own.threads);
    bool all = true;
    for (std::size_t t = first; t < end; ++t) {
      const Waits waits = own.fibers[t]->waits;
      all = all && (waits == Waits::for_warp || waits == Waits::ended);
    }
    for (std::size_t t = first; all && t < end; ++t) {
      if (own.fibers[t]->waits != Waits::for_warp) continue;
      own.fibers[t]->waits = Waits::no;
      released = true;
    }
  }
  if (released) return true;
  for (std::size_t t = 0; t < own.threads; ++t) {
    if (own.fibers[t]->waits != Waits::for_block) return false;
  }
  for (std::size_t t = 0; t < own.threads; ++t) own.fibers[t]->waits = Waits::no;
  return true;
}

bool all_ended() {
  Block& own = block();
  for (std::size_t t = 0; t < own.threads; ++t) {
    if (own.fibers[t]->waits != Waits::ended) return false;
  }
  return true;
}

/// Threads run in turn until each waits; every other turn goes backwards.
void run_block() {
  Block& own = block();
  for (bool forwards = true; !all_ended(); forwards = !forwards) {
    for (std::size_t i = 0; i < own.threads; ++i) {
      Fiber& fiber = *own.fibers[forwards ? i : own.threads - 1 - i];
      if (fiber.waits != Waits::no) continue;
      own.running = &fiber;
      switch_fibers(own.scheduler, fiber);
    }
    if (own.failure) give_up([&own] { std::rethrow_exception(std::exchange(own.failure, nullptr)); });
    if (!release_waiting() && !all_ended()) {
      give_up([] { throw std::logic_error("threads of a block wait for each other at different barriers"); });
    }
  }
}

int& launches_until_failure() {
  static thread_local int launches = -1;
  return launches;
}

}  // namespace

void fail_after(int launches) {
  launches_until_failure() = launches;
}

void run_kernel(dim3 grid, dim3 size, std::size_t shared_bytes, const std::function<void()>& thread) {
  if (launches_until_failure() >= 0 && launches_until_failure()-- == 0) throw std::runtime_error("a launch fails");
  Block& own = block();
  own.kernel = &thread;
  own.threads = std::size_t{size.x} * size.y * size.z;
  if (own.threads == 0 || own.threads > 1024) throw std::logic_error("a block has 1 to 1024 threads");
  if (grid.x == 0 || grid.y == 0 || grid.z == 0 || grid.y > 65535 || grid.z > 65535) {
    throw std::logic_error("a grid has at least one block, and at most 65535 down and deep");
  }
  constexpr std::size_t max_shared_bytes = std::size_t{48} << 10;  // of the smallest devices
  if (shared_bytes > max_shared_bytes) throw std::logic_error("a block has at most 48 KB of shared memory");
  own.scheduler.started = true;
  while (own.fibers.size() < own.threads) own.fibers.push_back(make_fiber());
#if defined(ROADSTEREO_EMULATED_RACES)
  own.scheduler.of_sanitizer = __tsan_get_current_fiber();
#endif
  if (own.shared.size() != shared_bytes) own.shared = std::vector<unsigned char>(shared_bytes);
  const bool forwards = own.launches++ % 2 == 0;
  const std::size_t blocks = std::size_t{grid.x} * grid.y * grid.z;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t index = forwards ? i : blocks - 1 - i;
    const auto x = static_cast<unsigned>(index % grid.x), rest = static_cast<unsigned>(index / grid.x);
    std::fill(own.shared.begin(), own.shared.end(), nothing_written);
    for (std::size_t t = 0; t < own.threads; ++t) {
      const auto n = static_cast<unsigned>(t);
      own.fibers[t]->here = {
          {n % size.x, n / size.x % size.y, n / size.x / size.y}, {x, rest % grid.y, rest / grid.y}, size, grid};
      own.fibers[t]->waits = Waits::no;
      own.fibers[t]->warp_waits = own.fibers[t]->block_waits = 0;
    }
    offer(&own.begun);
    run_block();
  }
}

void* shared_memory() {
  return block().shared.data();
}

const Here& here() {
  return block().running->here;
}

namespace {

std::size_t thread_of_block() {
  const Here& own = here();
  return own.thread.x + own.block_size.x * (own.thread.y + own.block_size.y * own.thread.z);
}

/// The fiber of a lane of the running thread's warp; null behind the end of the block.
Fiber* of_lane(int of) {
  const std::size_t other = thread_of_block() / warp * warp + static_cast<std::size_t>(of);
  return other < block().threads ? block().fibers[other].get() : nullptr;
}

}  // namespace

int lane() {
  return static_cast<int>(thread_of_block() % warp);
}

void wait_for_block() {
  Block& own = block();
  Fiber& self = *own.running;
  char& meeting = own.meeting.at[self.block_waits++ % 2];
  self.waits = Waits::for_block;
  offer(&meeting);
  switch_fibers(self, own.scheduler);
  accept(&meeting);
}

void wait_for_warp() {
  char& meeting = of_lane(0)->of_warp.at[block().running->warp_waits++ % 2];
  offer(&meeting);
  wait_in_warp();
  accept(&meeting);
}

namespace {

/// Leaves `bits` for the warp, waits for it, and returns which exchange this was.
unsigned leave(std::uint64_t bits) {
  Fiber& self = *block().running;
  const unsigned number = ++self.exchanges;
  self.left[number % 2] = {bits, number};
  wait_in_warp();
  return number;
}

}  // namespace

std::uint64_t exchange(std::uint64_t bits, int from) {
  const unsigned number = leave(bits);
  const Fiber* other = of_lane(from);
  return other != nullptr ? other->left[number % 2].bits : bits;
}

int smallest(int value) {
  const unsigned number = leave(static_cast<std::uint32_t>(value));
  for (int other = 0; other < warp; ++other) {
    const Fiber* fiber = of_lane(other);
    if (fiber == nullptr) continue;
    const Left& left = fiber->left[number % 2];
    if (left.exchange == number) value = std::min(value, static_cast<int>(static_cast<std::uint32_t>(left.bits)));
  }
  return value;
}

unsigned ballot(bool vote) {
  const unsigned number = leave(vote ? 1 : 0);
  unsigned votes = 0;
  for (int other = 0; other < warp; ++other) {
    const Fiber* fiber = of_lane(other);
    if (fiber == nullptr) continue;
    const Left& left = fiber->left[number % 2];
    if (left.exchange == number && left.bits == 1) votes |= 1U << other;
  }
  return votes;
}

}  // namespace roadstereo::cuda::emulated
