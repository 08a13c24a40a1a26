#include "suites/xgt_cnet/keyword_facts.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/p2p/keywords.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::xgt_cnet {

Status check_keyword_fact(const nlohmann::json& facts) {
  constexpr std::array<std::string_view, 4> keys{"address", "keyword", "model", "words"};
  if (const Status known = known_keys(facts, "a fact of P2P", keys); !known) return known;
  const PlcModel* model = find_plc_model(facts.value("model", ""));
  if (!model) return fail("a fact of P2P has model (" + plc_model_names() + "), keyword and address");
  const std::string keyword = facts.value("keyword", ""), due = facts.value("address", "");
  const std::optional<P2pKeyword> known = find_p2p_keyword(*model, keyword);
  if (!known) return fail(fmt::format("there is no keyword '{}'; Appendix 2 has such as _P2P1_NDR00 and _P1B00SN", keyword));
  const ParsedAddress address = parse_address(*model, due);
  if (!address || address.address != known->address)
    return fail(fmt::format("{} of {}: the table has {}, the manual {}", keyword, model->name, device_name(*model, known->address), due));
  if (const unsigned words = facts.value("words", known->words); words != known->words)
    return fail(fmt::format("{} of {}: the table has {} words, the manual {}", keyword, model->name, known->words, words));
  return ok();
}

}  // namespace fieldproof::xgt_cnet
