// Ctrl-C and SIGTERM as something that a wait can wait for. One for the whole process.
#pragma once

namespace fieldproof::os {

/// From now on SIGINT and SIGTERM end waits instead of the process; a second one of the same kind
/// ends the process, so that a hanging bench can still be left.
void catch_interrupts();

/// Has a signal come since `catch_interrupts`?
bool interrupted();

/// Readable for `ppoll` as long as `interrupted()`; nobody reads it.
int interrupt_fd();

/// As if the signal had come (tests, and a loop in another thread that must end).
void interrupt();

/// Forgets the interrupt, so that one process can be interrupted again (tests).
void clear_interrupt();

/// From now on SIGHUP makes this descriptor readable instead of ending the process; the reader
/// empties it.
int catch_hangup();

}  // namespace fieldproof::os
