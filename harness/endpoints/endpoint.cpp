#include "harness/endpoints/endpoint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <span>
#include <vector>

#include "harness/endpoints/echo.hpp"
#include "harness/endpoints/kinds.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::endpoints {

namespace {

using Options = std::span<const std::string_view>;

std::string unknown_kind(std::string_view name) {
  std::vector<std::string_view> names;
  for (const KindOf& kind : all_kinds()) names.push_back(kind.name);
  return fmt::format("unknown kind '{}'; the kinds are {}{}", name, fmt::join(names, ", "),
                     suggestion(name, names));
}

bool known(Options options, std::string_view key) {
  return options.empty() || std::ranges::find(options, key) != options.end();
}

/// Reads "station=1&protocol=xgt-cnet" into `options`; what is wrong with it, or empty.
std::string read_options(std::string_view text, const KindOf& kind,
                         std::map<std::string, std::string>& options) {
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    const std::string key(one.substr(0, one.find('=')));
    if (!known(kind.options, key)) {
      return fmt::format("unknown option '{}'; the options of {} are {}{}", key, kind.name,
                         fmt::join(kind.options, ", "), suggestion(key, kind.options));
    }
    if (key.empty() || key.size() == one.size())
      return fmt::format("option '{}' has no value; write KEY=VALUE", one);
    if (!options.emplace(key, one.substr(key.size() + 1)).second)
      return fmt::format("option '{}' is given twice; leave one", key);
  }
  return {};
}

/// A command keeps its own '?': behind the last one there are options only if it reads as such, and
/// no option of ours has a space (`exec:tool emulate xbc-h?station=1 --pty {tty}` is all command).
std::size_t options_of_command(std::string_view rest, const KindOf& kind) {
  const std::size_t mark = rest.rfind('?');
  if (mark == std::string_view::npos || mark + 1 == rest.size() ||
      rest.find(' ', mark) != std::string_view::npos)
    return std::string_view::npos;
  std::map<std::string, std::string> trial;
  return read_options(rest.substr(mark + 1), kind, trial).empty() ? mark : std::string_view::npos;
}

}  // namespace

Result<LinkId> Endpoint::open(Transport, std::uint16_t) {
  return fail(fmt::format("cannot open a link: {} is one line that is always open", describe()));
}

Result<LinkId> Endpoint::open_line(unsigned channel) {
  return fail(fmt::format("cannot reach channel {}: {} leads to one alone", channel, describe()));
}

Status Endpoint::close(LinkId, Closing) {
  return fail(fmt::format("cannot close a link: {} is one line that is always open", describe()));
}

Status Endpoint::set(std::string_view address, std::string_view) {
  return fail(fmt::format("cannot set {}: {} has no back door", address, describe()));
}

Result<std::string> Endpoint::get(std::string_view address, std::size_t) {
  return fail(fmt::format("cannot look at {}: {} has no back door", address, describe()));
}

Status Endpoint::act(std::string_view action) {
  return fail(fmt::format("cannot do {}: {} cannot be switched from here; do it by hand", action,
                          describe()));
}

Status Endpoint::renew() {
  return refuse(
      fmt::format("cannot switch {} off and on without asking whether it is up again, "
                  "which moves its counters: --control - knows no \"power_cycle\"",
                  describe()));
}

Status Endpoint::tell(std::string_view) {
  return fail(fmt::format(
      "cannot tell {} what to request: the bench has not started it; give --stimulus a command",
      describe()));
}

std::string Endpoint::answer(Duration) { return {}; }

std::string Endpoint::line_errors() { return {}; }

std::string EndpointName::option(const std::string& key, const std::string& fallback) const {
  const auto found = options.find(key);
  return found == options.end() ? fallback : found->second;
}

Result<EndpointName> parse_endpoint(std::string_view text) {
  const auto wrong = [text](const std::string& why) {
    return fail(fmt::format("cannot read endpoint '{}': {}", text, why));
  };
  EndpointName name;
  name.kind = text.substr(0, text.find_first_of(":?"));
  const KindOf& kind = kind_of(name);
  if (kind.name.empty()) return wrong(unknown_kind(name.kind));
  std::string_view rest = text.substr(name.kind.size());
  if (rest.starts_with(':')) rest.remove_prefix(1);
  const std::size_t mark = kind.free_target ? options_of_command(rest, kind) : rest.find('?');
  name.target = rest.substr(0, mark);
  if (name.target.empty() && !kind.target.empty()) {
    return wrong(
        fmt::format("nothing stands behind the colon; write {}:{}", kind.name, kind.target));
  }
  if (mark != std::string_view::npos)
    if (const std::string why = read_options(rest.substr(mark + 1), kind, name.options);
        !why.empty())
      return wrong(why);
  if (kind.check)
    if (const Status checked = kind.check(name); !checked) return wrong(checked.error().message);
  return name;
}

Result<std::unique_ptr<Endpoint>> open_endpoint(const EndpointName& name,
                                                const harness::Protocol& protocol) {
  const KindOf& kind = kind_of(name);
  if (kind.name.empty()) return fail("cannot open an endpoint: " + unknown_kind(name.kind));
  if (const Status fits = check_endpoint(name, protocol); !fits) return fits.error();
  Result<std::unique_ptr<Endpoint>> opened = kind.open(name, protocol);
  if (opened && removes_echo(name)) return without_echo(std::move(*opened));
  return opened;
}

}  // namespace fieldproof::endpoints
