// The kernel's terminal settings with any speed. <asm/termbits.h> cannot be included next to
// <termios.h>.
#pragma once

#include <asm-generic/ioctl.h>

#include <array>
#include <cstdint>

namespace fieldproof::os {

/// struct termios2 of the kernel.
struct KernelTermios {
  std::uint32_t input_flags;
  std::uint32_t output_flags;
  std::uint32_t control_flags;
  std::uint32_t local_flags;
  std::uint8_t line_discipline;
  std::array<std::uint8_t, 19> control_characters;
  std::uint32_t input_speed;
  std::uint32_t output_speed;
};
static_assert(sizeof(KernelTermios) == 44);

constexpr unsigned long get_kernel_termios = _IOR('T', 0x2A, KernelTermios);  // TCGETS2
constexpr unsigned long set_kernel_termios = _IOW('T', 0x2B, KernelTermios);  // TCSETS2

constexpr std::uint32_t speed_mask = 0x0000100F;  // CBAUD
constexpr std::uint32_t any_speed = 0x00001000;   // BOTHER: the speed stands in the speed fields
constexpr int input_speed_shift = 16;             // IBSHIFT

}  // namespace fieldproof::os
