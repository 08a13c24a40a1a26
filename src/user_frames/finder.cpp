#include "src/user_frames/finder.hpp"

#include "src/plc/counters.hpp"

namespace fieldproof::user_frames {

void FrameFinder::receive(const Burst& burst, Sink& sink) {
  if (silence_.is_over_before(burst)) {
    take_frames(burst.start, true, sink);
    passing_over_ = false;
  }
  burst.for_each([&](Byte b, Time end) {
    heard_.push_back(b);
    take_frames(end, false, sink);
  });
  silence_.heard(burst);
}

FrameFinder::Found FrameFinder::find(bool ended) const {
  Found best;
  for (const UserFrame* frame : frames_) {
    FrameMatch match = match_frame(*frame, heard_, ended);
    if (match.state == FrameMatch::State::complete && check_holds(*frame, match, heard_))
      return {std::move(match), frame};
    if (match.state > best.match.state) best.match = std::move(match);
  }
  return best;
}

void FrameFinder::take_frames(Time now, bool ended, Sink& sink) {
  while (!heard_.empty()) {
    if (heard_.size() > max_frame) return drop_heard(sink);
    const Found found = find(ended);
    switch (found.match.state) {
      case FrameMatch::State::no: pass_over(sink); break;
      case FrameMatch::State::complete: take(found, now, sink); break;
      case FrameMatch::State::partial: return ended ? drop_heard(sink) : void();
    }
  }
}

/// Cut off, or too long.
void FrameFinder::drop_heard(Sink& sink) {
  heard_.clear();
  sink.on_no_frame(plc::service_status::tail);
}

void FrameFinder::pass_over(Sink& sink) {
  heard_.erase(heard_.begin());
  if (!passing_over_) sink.on_no_frame(plc::service_status::head);
  passing_over_ = true;
}

void FrameFinder::take(const Found& found, Time now, Sink& sink) {
  const Bytes frame(heard_.begin(),
                    heard_.begin() + static_cast<std::ptrdiff_t>(found.match.length()));
  heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(frame.size()));
  passing_over_ = false;
  if (found.frame)
    sink.on_user_frame(*found.frame, found.match, frame, now);
  else
    sink.on_no_frame(plc::service_status::bcc);
}

std::optional<Time> FrameFinder::wake_at() const {
  if (heard_.empty()) return std::nullopt;
  return silence_.over_at();
}

void FrameFinder::advance(Time now, Sink& sink) {
  if (now >= wake_at().value_or(Time::max())) take_frames(now, true, sink);
}

void FrameFinder::reset() {
  heard_.clear();
  passing_over_ = false;
}

}  // namespace fieldproof::user_frames
