#include <fmt/format.h>

#include "harness/vectors/link_names.hpp"
#include "harness/vectors/lint/lint.hpp"

namespace fieldproof::vectors {

std::vector<std::string> lint_links(const VectorSet& set, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  const auto is_line = [&](const std::string& name) {
    const harness::Protocol* const protocol = protocols.find(name);
    return protocol && !protocol->on_network();
  };
  for (const Case& one : set.cases)
    if (const harness::Protocol* const protocol = protocols.find(one.protocol))
      if (const Status right = check_links(one, protocol->on_network(), is_line); !right)
        problems.push_back(fmt::format("{}: {}: {}", one.file, one.id, right.error().message));
  return problems;
}

}  // namespace fieldproof::vectors
