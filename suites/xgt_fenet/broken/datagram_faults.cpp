// Faults of datagrams (FEnet EN 5.2.1; DECISIONS.md fenet/udp, fenet/length-field).
#include <algorithm>
#include <memory>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

bool is_datagram(const Burst& one) { return one.event == LinkEvent::datagram; }

/// What it hears in one datagram.
MakeBehaviour hears_datagram(std::function<Bytes(Bytes datagram)> change) {
  return hears([=](Burst heard, Server&) {
    if (is_datagram(heard)) heard.bytes = change(std::move(heard.bytes));
    return heard.bytes.empty() && is_datagram(heard) ? Bursts{} : Bursts{std::move(heard)};
  });
}

/// All datagrams go to one of those that asked.
Behaviour answers_to(bool first) {
  auto senders = std::make_shared<std::vector<LinkId>>();
  return {.hear =
              [senders](Burst heard, Server&) {
                if (is_datagram(heard) && std::ranges::find(*senders, heard.link) == senders->end())
                  senders->push_back(heard.link);
                return Bursts{std::move(heard)};
              },
          .act =
              [senders, first](Bursts& does, Server&) {
                for (Burst& one : does)
                  if (is_datagram(one)) one.link = first ? senders->front() : senders->back();
              }};
}

/// At most so many senders are served.
Behaviour senders_at_most(std::size_t most) {
  auto senders = std::make_shared<std::vector<LinkId>>();
  return {.hear = [senders, most](Burst heard, Server&) {
    if (!is_datagram(heard)) return Bursts{std::move(heard)};
    if (std::ranges::find(*senders, heard.link) == senders->end()) {
      if (senders->size() >= most) return Bursts{};
      senders->push_back(heard.link);
    }
    return Bursts{std::move(heard)};
  }};
}

/// Datagrams of one sender are put together like a stream.
Behaviour datagrams_joined() {
  auto kept = std::make_shared<std::map<LinkId, Bytes>>();
  return {.hear = [kept](Burst heard, Server&) {
    if (!is_datagram(heard)) return Bursts{std::move(heard)};
    Bytes& all = (*kept)[heard.link];
    all.insert(all.end(), heard.bytes.begin(), heard.bytes.end());
    if (all.size() < body_at || all.size() < body_at + word_at(all, length_at)) return Bursts{};
    heard.bytes = std::exchange(all, {});
    return Bursts{std::move(heard)};
  }};
}

/// A datagram that came just so is passed over.
Behaviour repeated_is_lost() {
  auto last = std::make_shared<Bytes>();
  return {.hear = [last](Burst heard, Server&) {
    if (!is_datagram(heard)) return Bursts{std::move(heard)};
    const bool again = heard.bytes == *last;
    *last = heard.bytes;
    return again ? Bursts{} : Bursts{std::move(heard)};
  }};
}

Bytes with_right_length(Bytes datagram) {
  if (datagram.size() > body_at)
    put_word(datagram, length_at, static_cast<unsigned>(datagram.size() - body_at));
  return datagram;
}

}  // namespace

std::vector<Fault> datagram_faults() {
  return {
      {"datagrams_unanswered", "datagrams are not answered",
       hears_datagram([](Bytes) { return Bytes{}; }), "xgt_fenet/udp/read/word", "no answer"},
      {"datagrams_to_the_first", "all answers go to the port that asked first",
       [] { return answers_to(true); }, "xgt_fenet/udp/two_ports", ""},
      {"datagrams_to_all", "an answer goes to each port that has asked",
       [] {
         auto senders = std::make_shared<std::vector<LinkId>>();
         return Behaviour{.hear =
                              [senders](Burst heard, Server&) {
                                if (is_datagram(heard)) senders->push_back(heard.link);
                                return Bursts{std::move(heard)};
                              },
                          .act =
                              [senders](Bursts& does, Server&) {
                                Bursts more;
                                for (const Burst& one : does)
                                  for (const LinkId link : *senders)
                                    if (is_datagram(one) && link != one.link) {
                                      more.push_back(one);
                                      more.back().link = link;
                                    }
                                std::ranges::move(more, std::back_inserter(does));
                              }};
       },
       "xgt_fenet/udp/two_ports", ""},
      {"one_sender", "one port alone is served, as table 6-1 may be read",
       [] { return senders_at_most(1); }, "xgt_fenet/udp/two_ports", "no answer"},
      {"four_senders", "four ports are served, as table 6-1 may be read",
       [] { return senders_at_most(4); }, "xgt_fenet/udp/ten_ports", "no answer"},
      {"datagrams_joined", "a frame may come in several datagrams", datagrams_joined,
       "xgt_fenet/udp/halves", ""},
      {"repeated_datagram_lost", "a datagram that comes twice is answered once", repeated_is_lost,
       "xgt_fenet/udp/repeated", ""},
      {"datagram_length_ignored", "the length field of a datagram is not looked at",
       hears_datagram(with_right_length), "xgt_fenet/length/datagram_length_field/l15", ""},
      {"datagram_surplus_ignored", "what follows the frame in a datagram is not looked at",
       hears_datagram([](Bytes datagram) {
         const std::size_t end = body_at + word_at(datagram, length_at);
         if (datagram.size() > body_at && end < datagram.size()) datagram.resize(end);
         return datagram;
       }),
       "xgt_fenet/udp/long/one_byte", ""},
      {"short_datagram_answered", "a datagram shorter than a header is answered",
       hears_datagram([](Bytes datagram) {
         if (datagram.size() < body_at) datagram.resize(body_at);
         return datagram;
       }),
       "xgt_fenet/udp/short/b10", ""},
      {"refused_datagram_unanswered", "a datagram that is refused draws no answer",
       acts([](Bursts& does, Server&) {
         std::erase_if(does,
                       [](const Burst& one) { return is_datagram(one) && is_refusal(one.bytes); });
       }),
       "xgt_fenet/udp/refused/end", "no answer"},
      {"datagram_writes_nothing", "a write over UDP is answered and not done",
       hears_datagram([](Bytes datagram) {
         if (is_write(datagram) && !is_continuous(datagram) && names_of(datagram).size() == 1)
           datagram[names_of(datagram)[0].at + 1] = 'L';
         return datagram;
       }),
       "xgt_fenet/udp/write/word", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
