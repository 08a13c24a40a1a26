// What tests of the endpoints share: a name made of parts, and test_link.hpp.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/system/test_link.hpp"

namespace fieldproof::endpoints::test {

inline EndpointName endpoint_name(std::string kind, std::string target,
                                  std::map<std::string, std::string> options = {}) {
  return {std::move(kind), std::move(target), std::move(options)};
}

}  // namespace fieldproof::endpoints::test
