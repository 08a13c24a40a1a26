// The e-mail service of an Ethernet module (FEnet EN 7.4): mails of ESEND blocks and of the CPU's
// events go to one SMTP server, one at a time, in the order in which they were asked for, each over
// a connection of its own.
//
// A block works as those of P2P channels do: rising edge or clock, in RUN with the link enabled,
// results in L; what is under way when the CPU stops is given up, and its connection reset. The
// mails of events go out in STOP, too, whatever the link enable is; how they end shows nowhere.
// A server that is silent for 30 s is given up, and so is the mail: nothing is repeated.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/email/cpu_watch.hpp"
#include "src/email/esend_driver.hpp"
#include "src/email/smtp_dialogue.hpp"
#include "src/net/own_links.hpp"
#include "src/p2p/client.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::email {

/// Of the server, for each reply: it may look names up before it greets (DECISIONS.md email/smtp).
constexpr Duration reply_time_out = 30s;

class EmailService : public plc::NetworkService {
 public:
  /// The esend blocks of `parameters`, which EsendDriver::check has passed; `memory` and `links`
  /// outlive the service.
  EmailService(EmailSettings settings, plc::PlcMemory& memory, const p2p::P2pParameters& parameters,
               net::OwnLinks& links);

  std::vector<Port> ports() const override { return {}; }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return blocks_.counters(); }
  /// Mails are lost; the server hears of it when it next says something.
  void power_cycle() override;
  void set_run(bool run) override;
  void scan() override { blocks_.scan(); }
  /// "link on", "link off"; "error on", "error off": of the CPU.
  std::vector<std::string> actions() const override;
  std::optional<Status> act(std::string_view action) override;

 private:
  struct Waiting {
    Mail mail;
    bool of_block = false;
  };
  /// A mail on its way.
  struct Sending {
    SmtpDialogue dialogue;
    LinkId link = line_link;
    bool of_block = false, told = false;  // told: its block knows the end
    Time deadline{};
  };

  bool watches() const;
  CpuWatch::State cpu() const { return {run_, error_}; }
  void collect();
  void start_next();
  void say(std::string text);
  void settle();
  void end_connection(LinkEvent how);
  void give_up_blocks();
  void receive_of_old(const Burst& burst);
  void event(LinkId link, LinkEvent what);

  const EmailSettings settings_;
  net::OwnLinks& links_;
  EsendDriver* driver_ = nullptr;  // of blocks_
  p2p::P2pClient blocks_;
  CpuWatch watch_;
  bool powered_ = false;  // the watch runs
  bool run_ = false, error_ = false;
  std::deque<Waiting> waiting_;
  std::optional<Sending> sending_;
  std::map<LinkId, bool> old_;  // links that are of no use any more: were they closed from here?
  std::vector<Burst> doings_;
  Time now_{};
};

}  // namespace fieldproof::email
