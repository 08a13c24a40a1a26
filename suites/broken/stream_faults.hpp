// What servers on networks do wrong with the stream of a connection, whatever their frames are:
// behaviours for the tables of faults.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "suites/broken/network_server.hpp"

namespace fieldproof::broken {

constexpr std::size_t all_frames = ~std::size_t{0};

/// How many bytes of whole frames `bytes` begins with, at most `frames` of them. A frame has a head
/// of so many bytes, and as many behind it as `length` reads in the head that begins at `at`.
inline std::size_t whole_frames(const Bytes& bytes, std::size_t frames, std::size_t head,
                                unsigned (*length)(const Bytes& bytes, std::size_t at)) {
  std::size_t at = 0;
  for (; frames > 0 && at + head <= bytes.size(); --frames) {
    const std::size_t end = at + head + length(bytes, at);
    if (end > bytes.size()) break;
    at = end;
  }
  return at;
}

/// The whole frames that a stream begins with; the stream goes on behind them.
using Whole = std::size_t (*)(const Bytes& stream);
inline Bytes take_whole(Bytes& stream, Whole whole) {
  const auto end = stream.begin() + static_cast<std::ptrdiff_t>(whole(stream));
  Bytes frames(stream.begin(), end);
  stream.erase(stream.begin(), end);
  return frames;
}

/// Puts one stream together for all connections; whoever completes a frame gets the answer.
template <typename Settings>
NetworkBehaviour<Settings> one_stream(Whole whole) {
  auto kept = std::make_shared<Bytes>();
  return {.hear = [kept, whole](Burst heard, Server&) {
    if (heard.event != LinkEvent::data) return Bursts{std::move(heard)};
    kept->insert(kept->end(), heard.bytes.begin(), heard.bytes.end());
    heard.bytes = take_whole(*kept, whole);
    return Bursts{std::move(heard)};
  }};
}

/// A half frame stays when its connection ends so, and the next connection goes on with it.
template <typename Settings>
NetworkBehaviour<Settings> half_stays(Whole whole, LinkEvent ending) {
  struct Kept {
    std::map<LinkId, Bytes> streams;
    Bytes left;
  };
  auto kept = std::make_shared<Kept>();
  return {.hear = [kept, whole, ending](Burst heard, Server&) {
    if (heard.event == LinkEvent::opened) {
      kept->streams[heard.link] = std::exchange(kept->left, {});
    } else if (heard.event == LinkEvent::data) {
      Bytes& stream = kept->streams[heard.link];
      stream.insert(stream.end(), heard.bytes.begin(), heard.bytes.end());
      heard.bytes = take_whole(stream, whole);
    } else if (heard.event == ending) {
      kept->left = kept->streams[heard.link];
    }
    return Bursts{std::move(heard)};
  }};
}

/// What the good server hears in one segment.
template <typename Settings>
auto hears_segment(std::function<Bytes(Bytes segment)> change) {
  return Makes<Settings>::hears([=](Burst heard, Server&) {
    if (heard.event == LinkEvent::data) heard.bytes = change(std::move(heard.bytes));
    return Bursts{std::move(heard)};
  });
}

}  // namespace fieldproof::broken
