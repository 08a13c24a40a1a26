// Finds user frames in what arrives (suites/user_frames/definitions/README.md 'What the device
// does').
//
// Bytes that can belong to no frame are passed over until one begins. The first frame of the list
// that is complete is found. One of fixed size ends with its last byte; a variable one where its
// tail stands first or, without constants in the tail, when nothing has come for longer than the
// inter-character time. That time also ends an incomplete frame.
#pragma once

#include <optional>
#include <vector>

#include "src/line/device.hpp"
#include "src/line/silence.hpp"
#include "src/user_frames/codec.hpp"

namespace fieldproof::user_frames {

class FrameFinder {
 public:
  class Sink {
   public:
    /// `bytes` are `frame`, its check is right; nothing is stored yet.
    virtual void on_user_frame(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
                               Time end) = 0;
    /// service_status: head (bytes of no frame, once a run of them), tail (cut off, or too long),
    /// bcc.
    virtual void on_no_frame(std::uint16_t why) = 0;

   protected:
    ~Sink() = default;
  };

  /// `frames` must outlive the finder. `gap`: the inter-character time.
  FrameFinder(std::vector<const UserFrame*> frames, Duration gap)
      : frames_(std::move(frames)), silence_(gap) {}

  void receive(const Burst& burst, Sink& sink);
  /// When silence ends what was heard.
  std::optional<Time> wake_at() const;
  void advance(Time now, Sink& sink);
  void reset();

 private:
  struct Found {
    FrameMatch match;
    const UserFrame* frame = nullptr;  // of a complete match; nullptr: its check is wrong
  };
  /// What the bytes heard begin with.
  Found find(bool ended) const;
  void take_frames(Time now, bool ended, Sink& sink);
  void take(const Found& found, Time now, Sink& sink);
  void pass_over(Sink& sink);
  void drop_heard(Sink& sink);

  std::vector<const UserFrame*> frames_;
  line::Silence silence_;
  Bytes heard_;                // since the last frame
  bool passing_over_ = false;  // bytes of no frame, already told
};

}  // namespace fieldproof::user_frames
