// E-mail settings for tests: Tony, Peter, and both as a group; a text, and one with bytes.
#pragma once

#include <nlohmann/json.hpp>

namespace fieldproof::email::test {

inline nlohmann::json settings() {
  return nlohmann::json::parse(R"({
    "user": "PLC", "address": "plc@plant.example", "server": "10.0.0.25",
    "addresses": [{"name": "Tony", "address": "tony@plant.example"},
                  {"name": "Peter", "address": "peter@plant.example"},
                  {"number": 9, "name": "Friend", "group": [1, 0]}],
    "messages": [{"title": "Pump", "parts": [{"text": "off", "change": true}]},
                 {"number": 4, "title": "Tank", "parts": [{"text": "level "}, {"mb": 3}]}]})");
}

inline nlohmann::json with(nlohmann::json object, const nlohmann::json& changes) {
  object.update(changes);
  return object;
}

}  // namespace fieldproof::email::test
