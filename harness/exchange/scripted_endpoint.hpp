// An endpoint for tests: answers each transmission by a table, in simulated time, with bursts at
// given moments.
#pragma once

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::exchange {

class ScriptedEndpoint : public endpoints::Endpoint {
 public:
  struct Piece {
    Duration after;  // the end of the transmission
    std::string text;
  };

  endpoints::Capabilities can{.simulated = true, .wire = true};
  std::map<std::string, std::vector<Piece>> answers;  // by what was sent
  std::map<std::string, std::string> memory;          // back door
  std::vector<std::string> sent;
  std::vector<nlohmann::json> begun;
  int fails_after = -1;  // transmissions until the port fails
  int power_cycles = 0;
  bool lets_in = true;  // others, where the line is shared
  std::string forgets;  // answered so often, then never again
  int forgets_after = 1;

  const endpoints::Capabilities& capabilities() const override { return can; }
  std::string describe() const override { return "scripted"; }
  Time now() const override { return now_; }
  Duration character_time() const override { return 1ms; }
  void has_no_wire() override { can.wire = can.paced = false; }
  Status begin(const nlohmann::json& config) override {
    begun.push_back(config);
    return ok();
  }

  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    if (fails_after >= 0 && static_cast<int>(sent.size()) >= fails_after)
      return fail("the port is gone");
    sent.push_back(to_text(bytes));
    const Sent when{now_, now_ + character_time() * static_cast<Duration::rep>(bytes.size())};
    now_ = when.end;
    for (const Piece& piece : answers[sent.back()])
      coming_.push_back({to_bytes(piece.text), now_ + piece.after, character_time()});
    if (sent.back() == forgets && --forgets_after == 0) answers.erase(forgets);
    return when;
  }

  Result<Burst> receive(Time deadline) override {
    if (coming_.empty() || coming_.front().end() > deadline) {
      now_ = std::max(now_, deadline);
      return Burst{};
    }
    Burst burst = coming_.front();
    coming_.pop_front();
    now_ = std::max(now_, burst.end());
    return burst;
  }

  bool lets_others_in() override { return lets_in; }

  Status set(std::string_view address, std::string_view hex) override {
    memory[std::string(address)] = hex;
    return ok();
  }
  Result<std::string> get(std::string_view address, std::size_t) override {
    return memory[std::string(address)];
  }
  Status act(std::string_view action) override {
    if (action != "power_cycle") return fail("no such action");
    ++power_cycles;
    return ok();
  }

 private:
  Time now_{};
  std::deque<Burst> coming_;
};

}  // namespace fieldproof::exchange
