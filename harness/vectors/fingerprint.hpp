// FNV-1a, 64 bits: tells vector sets and quotes apart; guards nothing.
#pragma once

#include <cstdint>
#include <string_view>

namespace fieldproof::vectors {

inline constexpr std::uint64_t empty_fingerprint = 0xCBF29CE484222325ull;

/// The fingerprint of what `fingerprint` stands for, followed by `text`.
constexpr std::uint64_t extend_fingerprint(std::uint64_t fingerprint, std::string_view text) {
  for (const char c : text)
    fingerprint = (fingerprint ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  return fingerprint;
}

}  // namespace fieldproof::vectors
