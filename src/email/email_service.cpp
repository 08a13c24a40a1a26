#include "src/email/email_service.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::email {

namespace {
/// That a server leaves open: the oldest is reset then.
constexpr std::size_t most_old_links = 8;

/// The dialogue has time-outs of its own, and always comes to an end.
constexpr p2p::P2pClient::Timing no_time_out{.time_out = 24h};

std::unique_ptr<EsendDriver> driver_for(const EmailSettings& settings, EsendDriver*& known) {
  auto driver = std::make_unique<EsendDriver>(settings);
  known = driver.get();
  return driver;
}
}  // namespace

EmailService::EmailService(EmailSettings settings, plc::PlcMemory& memory,
                           const p2p::P2pParameters& parameters, net::OwnLinks& links)
    : settings_(std::move(settings)),
      links_(links),
      blocks_(memory, parameters, 0, driver_for(settings_, driver_), no_time_out,
              [&memory] { memory.written(); }),
      watch_(settings_.period) {}

bool EmailService::watches() const {
  return settings_.use &&
         std::ranges::any_of(settings_.events, [](const auto& event) { return event.has_value(); });
}

void EmailService::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  if (!sending_ || burst.link != sending_->link) return receive_of_old(burst);
  if (burst.event == LinkEvent::data) {
    say(sending_->dialogue.hear(burst.bytes));
  } else {
    sending_->dialogue.give_up();
    if (burst.event == LinkEvent::closed) event(sending_->link, LinkEvent::closed);
    sending_->link = line_link;  // there is nothing left to end
  }
  settle();
}

/// RST is the answer but to what ends it.
void EmailService::receive_of_old(const Burst& burst) {
  const auto found = old_.find(burst.link);
  if (found == old_.end()) return;
  const bool over =
      burst.event == LinkEvent::reset || (burst.event == LinkEvent::closed && found->second);
  old_.erase(found);
  if (!over) event(burst.link, LinkEvent::reset);
}

std::optional<Time> EmailService::wake_at() const {
  if (!doings_.empty() || (!powered_ && watches()) || (!sending_ && !waiting_.empty())) return now_;
  std::optional<Time> wake = blocks_.wake_at();
  const auto earlier = [&wake](Time at) { wake = wake ? std::min(*wake, at) : at; };
  if (watches()) earlier(watch_.next());
  if (sending_) earlier(sending_->deadline);
  return wake;
}

std::vector<Burst> EmailService::advance(Time now) {
  now_ = std::max(now_, now);
  if (!std::exchange(powered_, true)) watch_.begin(now_, cpu());
  if (sending_ && now_ >= sending_->deadline) {
    sending_->dialogue.give_up();
    settle();
  }
  collect();
  if (!sending_) start_next();
  return std::exchange(doings_, {});
}

/// What is to be mailed.
void EmailService::collect() {
  if (watches())
    for (const CpuEvent event : watch_.look(now_, cpu()))
      if (const auto& mail = settings_.events[static_cast<std::size_t>(event)])
        waiting_.push_back({make_mail(settings_, *mail), false});
  if (!blocks_.advance(now_).empty()) waiting_.push_back({driver_->take_mail(), true});
}

void EmailService::start_next() {
  if (waiting_.empty()) return;
  Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  sending_.emplace(Sending{SmtpDialogue(std::move(next.mail)), links_.next(), next.of_block, false,
                           now_ + reply_time_out});
  doings_.push_back({.bytes = {},
                     .start = now_,
                     .link = sending_->link,
                     .event = LinkEvent::opened,
                     .port = settings_.port,
                     .peer = settings_.server});
}

void EmailService::say(std::string text) {
  if (text.empty()) return;
  sending_->deadline = now_ + reply_time_out;
  doings_.push_back({.bytes = to_bytes(text), .start = now_, .link = sending_->link});
}

/// Tells the block how its mail ended, as soon as that is known, and ends what is over.
void EmailService::settle() {
  const std::optional<std::uint16_t> result = sending_->dialogue.result();
  const bool tell = result && sending_->of_block && !std::exchange(sending_->told, true);
  if (sending_->dialogue.over()) end_connection(LinkEvent::closed);
  if (tell) blocks_.receive({.bytes = ended_with(*result), .start = now_});
}

void EmailService::end_connection(LinkEvent how) {
  const LinkId link = std::exchange(sending_, std::nullopt)->link;
  if (link == line_link) return;
  event(link, how);
  if (how == LinkEvent::closed) old_[link] = true;
  if (old_.size() <= most_old_links) return;
  event(old_.begin()->first, LinkEvent::reset);
  old_.erase(old_.begin());
}

void EmailService::event(LinkId link, LinkEvent what) {
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = what});
}

/// A mail that the server has taken is said good-bye to as usual.
void EmailService::give_up_blocks() {
  std::erase_if(waiting_, &Waiting::of_block);
  if (sending_ && sending_->of_block && !sending_->told) end_connection(LinkEvent::reset);
}

void EmailService::set_run(bool run) {
  run_ = run;
  blocks_.set_run(run);
  if (!run) give_up_blocks();
}

std::vector<std::string> EmailService::actions() const {
  std::vector<std::string> all = blocks_.actions();
  all.insert(all.end(), {"error on", "error off"});
  return all;
}

std::optional<Status> EmailService::act(std::string_view action) {
  if (action == "error on" || action == "error off") {
    error_ = action == "error on";
    return ok();
  }
  std::optional<Status> done = blocks_.act(action);
  if (action == "link off") give_up_blocks();
  return done;
}

void EmailService::power_cycle() {
  blocks_.power_cycle();
  waiting_.clear();
  doings_.clear();
  if (sending_) old_[sending_->link] = false;
  sending_.reset();
  powered_ = false;
}

}  // namespace fieldproof::email
