// Requests from outside by signal: SIGUSR1 asks for a checkpoint; SIGUSR2, SIGTERM and SIGINT for a
// checkpoint and the end of the run.
#pragma once

namespace alphadot {

/// Listens for its lifetime; without it signals do what they do by default. A second SIGTERM or SIGINT ends
/// the program at once.
class SignalListener {
 public:
  SignalListener();
  ~SignalListener();
  SignalListener(const SignalListener&) = delete;
  SignalListener& operator=(const SignalListener&) = delete;
};

/// Whether this rank has been asked for a checkpoint since the last call.
bool take_checkpoint_signal();

/// Whether this rank has been asked to end.
bool stop_signalled();

}  // namespace alphadot
