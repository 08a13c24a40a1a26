#include "harness/vectors/links.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/vectors/broken.hpp"

namespace fieldproof::vectors {

namespace {

bool is_on_a_link(Step::Kind kind) {
  using enum Step::Kind;
  return kind == send || kind == expect || kind == silence || kind == close ||
         kind == expect_close || kind == partner;
}

}  // namespace

void Links::resolve(Step& step) {
  if (!named_) return;
  if (step.kind == Step::Kind::open) return open(step);
  if (!is_on_a_link(step.kind)) {
    if (!step.on.empty()) throw Broken("\"on\" has no meaning in this step; take it out");
    return;
  }
  Link& link = of(step);
  step.on = link.name;
  if (step.kind == Step::Kind::close || step.kind == Step::Kind::expect_close) link.ended = true;
  if (step.kind == Step::Kind::close && step.closing != Closing::fin)
    std::erase_if(links_, [&](const Link& one) { return one.name == step.on; });
}

bool Links::is_datagram(const std::string& name) const {
  const auto found = std::ranges::find(links_, name, &Link::name);
  return found != links_.end() && found->transport == Transport::udp;
}

void Links::open(const Step& step) {
  if (std::ranges::count(links_, step.on, &Link::name))
    throw Broken(fmt::format("a link '{}' is open already; choose another name", step.on));
  links_.push_back({step.on, step.link.transport});
}

Links::Link& Links::of(const Step& step) {
  const auto is_open = [](const Link& link) { return !link.ended; };
  if (step.on.empty()) {
    if (std::ranges::count_if(links_, is_open) != 1)
      throw Broken(fmt::format("say on which link this is (\"on\"); {}", open_links()));
    return *std::ranges::find_if(links_, is_open);
  }
  const auto found = std::ranges::find(links_, step.on, &Link::name);
  if (found == links_.end())
    throw Broken(fmt::format("no link '{}' is open; {}", step.on, open_links()));
  return *found;
}

std::string Links::open_links() const {
  std::vector<std::string> names;
  for (const Link& link : links_)
    names.push_back(fmt::format("'{}'{}", link.name, link.ended ? " (ended)" : ""));
  return names.empty() ? "none is open" : fmt::format("open: {}", fmt::join(names, ", "));
}

}  // namespace fieldproof::vectors
