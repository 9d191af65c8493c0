// The command line of `scree render`.
#pragma once

#include <CLI/CLI.hpp>

#include "runtime/render/command.h"

namespace scree {

// Adds the command and its options, which fill `arguments`.
CLI::App& add_render_command(CLI::App& app, RenderArguments& arguments);

}  // namespace scree
