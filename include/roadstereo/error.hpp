#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Invalid input or a failed operation. The message is one sentence for the user: it names the file or the argument,
/// its value, and the values that are allowed.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Error of the system, not of the input, such as a full disk or a failed write. The command line exits with 1 instead
/// of 2.
class SystemError : public Error {
 public:
  using Error::Error;
};

/// Throws `E` with the message made of `parts`, written one after the other.
template <class E = Error, class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream message;
  message.precision(10);
  (message << ... << parts);
  throw E(message.str());
}

}  // namespace roadstereo
#pragma GCC visibility pop
