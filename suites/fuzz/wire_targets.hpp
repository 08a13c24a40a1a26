// What comes over a line or a network: codecs, stream splitters, the emulated devices.
#pragma once

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// The first byte chooses the protocol, the rest are bytes of its stream.
void feed_frames(ByteView input);
/// The same for an emulated device; the bytes come in pieces with pauses. It answers a probe behind
/// them.
void feed_device(ByteView input);
/// ADDRESS=HEX: what a journal or a vector wants written, behind the number of the protocol.
void feed_memory(ByteView input);
std::vector<Bytes> memory_of_vectors();
/// The first byte says in pieces of how many bytes the others come from an RFC 2217 server.
void feed_telnet(ByteView input);
std::vector<Bytes> good_telnet();
/// The frames of the vectors, behind the number of their protocol.
std::vector<Bytes> frames_of_vectors();
/// The same as pieces for feed_device.
std::vector<Bytes> streams_of_vectors();

}  // namespace fieldproof::fuzz
