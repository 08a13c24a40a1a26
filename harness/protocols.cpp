#include "harness/protocols.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "src/base/spelling.hpp"

namespace fieldproof::harness {

const Protocol* Protocols::find(std::string_view name) const {
  for (const Protocol* protocol : table_)
    if (protocol->name() == name) return protocol;
  return nullptr;
}

namespace {

Error unknown_protocol(const Protocols& table, std::string_view name) {
  std::vector<std::string_view> names;
  for (const Protocol* protocol : table) names.push_back(protocol->name());
  return fail(fmt::format("there is no protocol '{}'; use one of {}{}", name,
                          fmt::join(names, ", "), suggestion(name, names)));
}

Error unknown_model(const Protocols& table, std::string_view model) {
  std::vector<std::string> models;
  for (const Protocol* protocol : table)
    for (const std::string& one : protocol->models())
      if (std::ranges::count(models, one) == 0) models.push_back(one);
  const std::vector<std::string_view> known(models.begin(), models.end());
  return fail(fmt::format("there is no model '{}'; use one of {}{}", model, fmt::join(known, ", "),
                          suggestion(model, known)));
}

}  // namespace

std::optional<Protocol::WordName> Protocols::read_word(std::string_view text) const {
  for (const Protocol* protocol : table_)
    if (std::optional<Protocol::WordName> word = protocol->read_word(text)) return word;
  return std::nullopt;
}

unsigned Protocols::last_axis() const {
  unsigned last = 0;
  for (const Protocol* protocol : table_) last = std::max(last, protocol->last_axis());
  return last;
}

Result<const Protocol*> Protocols::choose(std::string_view name, std::string_view model) const {
  for (const Protocol* protocol : table_)
    if (name.empty() ? model.empty() || protocol->has_model(model) : protocol->name() == name)
      return &protocol->of_model(model);
  return name.empty() ? unknown_model(*this, model) : unknown_protocol(*this, name);
}

}  // namespace fieldproof::harness
