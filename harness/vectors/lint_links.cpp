#include <fmt/format.h>

#include <map>

#include "harness/vectors/lint.hpp"

namespace fieldproof::vectors {

namespace {

/// Follows the links of one case.
class LinksOfCase {
 public:
  LinksOfCase(const Case& one, const harness::Protocols& protocols)
      : protocols_(protocols), own_(one.protocol) {}

  /// Why the step cannot be done; empty: it can.
  std::string wrong(const Step& step) {
    if (step.kind == Step::Kind::open) return open(step);
    if (step.kind != Step::Kind::close && step.kind != Step::Kind::expect_close) return {};
    const auto opened = protocol_of_.find(step.on);
    const std::string& name = opened == protocol_of_.end() ? own_ : opened->second;
    if (!is_line(name)) return {};
    return fmt::format(
        "{} runs on a serial line, which neither side can close; take \"{}\" out, or name a link "
        "of a protocol of a network (\"on\")",
        name, step.kind == Step::Kind::close ? "close" : "expect_close");
  }

 private:
  std::string open(const Step& step) {
    const std::string& name = protocol_of_[step.on] =
        step.link.protocol.empty() ? own_ : step.link.protocol;
    if (!step.link.protocol.empty() || !is_line(name)) return {};
    return fmt::format(
        "{} runs on a serial line, which is always open; take \"open\" out, or name the "
        "\"protocol\" of another service of the device",
        name);
  }

  bool is_line(const std::string& name) const {
    const harness::Protocol* const protocol = protocols_.find(name);
    return protocol && protocol->default_port() == 0;
  }

  const harness::Protocols& protocols_;
  std::string own_;
  std::map<std::string, std::string> protocol_of_;  // by link
};

}  // namespace

std::vector<std::string> lint_links(const VectorSet& set, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  for (const Case& one : set.cases) {
    LinksOfCase links(one, protocols);
    for (std::size_t i = 0; i < one.steps.size(); ++i)
      if (const std::string why = links.wrong(one.steps[i]); !why.empty())
        problems.push_back(fmt::format("{}: {}: steps[{}]: {}", one.file, one.id, i, why));
  }
  return problems;
}

}  // namespace fieldproof::vectors
