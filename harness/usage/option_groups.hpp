// The many options of `run` in groups, for its help.
#pragma once

namespace CLI {
class App;
}

namespace fieldproof::usage {

/// Of `run` and of commands that share its options: each into its group. One that no group has
/// stands under "Options", where a test finds it.
void group_options(CLI::App& app);

}  // namespace fieldproof::usage
