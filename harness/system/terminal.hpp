// How wide the lines may be that a person reads.
#pragma once

namespace fieldproof::os {

/// COLUMNS where it is set, else what the terminal behind `fd` says (80 where it says nothing). 0:
/// no terminal, whose lines stay as they are. At least 20.
int terminal_columns(int fd);

}  // namespace fieldproof::os
