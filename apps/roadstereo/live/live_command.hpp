#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "roadstereo/io/frame_source.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Opens the source named on the command line.
using NamedOpener =
    std::function<std::unique_ptr<io::FrameSource>(const std::vector<std::string>&, const io::SourceOptions&)>;

/// Adds `live`, with sources from `opener`.
void add_live_command(CLI::App& app, const NamedOpener& opener);

}  // namespace roadstereo::cli
