// What is compiled of nlohmann-json once, in json_once.cpp, and not in every file that reads some.
#include <nlohmann/json.hpp>

#ifndef FIELDPROOF_JSON_ONCE
#define FIELDPROOF_JSON_ONCE extern
#endif

// Its readers are templates by the kind of JSON and by where the text lies.
#define FIELDPROOF_JSON_READER(kind, text)                                             \
  FIELDPROOF_JSON_ONCE template class nlohmann::detail::lexer<nlohmann::kind,          \
                                                              nlohmann::detail::text>; \
  FIELDPROOF_JSON_ONCE template class nlohmann::detail::parser<nlohmann::kind,         \
                                                               nlohmann::detail::text>
#define FIELDPROOF_JSON(kind)                                                                \
  FIELDPROOF_JSON_ONCE template class nlohmann::detail::serializer<nlohmann::kind>;          \
  FIELDPROOF_JSON_ONCE template class nlohmann::detail::json_sax_dom_parser<nlohmann::kind>; \
  FIELDPROOF_JSON_ONCE template class nlohmann::detail::json_sax_dom_callback_parser<        \
      nlohmann::kind>;                                                                       \
  FIELDPROOF_JSON_READER(kind, iterator_input_adapter<const char*>);                         \
  FIELDPROOF_JSON_READER(kind, iterator_input_adapter<std::string::const_iterator>);         \
  FIELDPROOF_JSON_READER(kind, input_stream_adapter)

FIELDPROOF_JSON_ONCE template class nlohmann::basic_json<>;
FIELDPROOF_JSON(json);
FIELDPROOF_JSON(ordered_json);
