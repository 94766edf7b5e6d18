#pragma once

#include <string>

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Returns a message about the first word of a parsed command line that is neither a command nor an option, with the
/// nearest one by edit distance if it is near: "there is no command 'inspekt'; the nearest is 'inspect'". Empty if all
/// words are known.
std::string unknown_word(const CLI::App& app);

}  // namespace roadstereo::cli
