// Numbers for the links that a host opens itself.
#pragma once

#include "src/base/burst.hpp"

namespace fieldproof::net {

/// One a host, shared by all that open links on it.
class OwnLinks {
 public:
  /// A number that was never given before.
  LinkId next() { return next_++; }

 private:
  LinkId next_ = first_own_link;
};

}  // namespace fieldproof::net
