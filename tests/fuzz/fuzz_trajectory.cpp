// A trajectory; what is read is written and read again.
#include "memory_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/trajectory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadstereo;
  static MemoryFile file;
  try {
    const Trajectory trajectory = io::read_trajectory(file.hold(data, size));
    const std::string text = io::kitti_trajectory(trajectory, io::longest_piece(trajectory));
    const Trajectory again =
        io::read_trajectory(file.hold(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    if (again.frames.size() != trajectory.frames.size()) __builtin_trap();
  } catch (const Error&) {
  }
  return 0;
}
