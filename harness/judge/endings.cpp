#include "harness/judge/endings.hpp"

#include <fmt/format.h>

namespace fieldproof::judging {

std::string in_words(const exchange::Ending& ending) {
  const std::string& name = ending.event->link;
  const std::string link = name.empty() ? "the connection" : "connection " + name;
  if (ending.refused()) return link + " was refused, or reset (RST) before anything went over it";
  const bool reset = ending.event->kind == results::Event::Kind::reset;
  return fmt::format("the device {} {} ({}) after {} bytes from it", reset ? "reset" : "closed",
                     link, reset ? "RST" : "FIN", ending.received);
}

std::string in_words(const exchange::Ending& ending, Time cause, const std::string& what) {
  const Duration since = ending.event->start - cause;
  return fmt::format("{}, {:.1f} ms {} {}", in_words(ending), to_ms(since < 0ns ? -since : since),
                     since < 0ns ? "before" : "after", what);
}

}  // namespace fieldproof::judging
