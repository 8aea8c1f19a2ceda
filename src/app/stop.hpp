// Requests from outside by signal: SIGUSR1 asks for a checkpoint; SIGUSR2, SIGTERM, SIGINT and SIGHUP for a
// checkpoint and the end of the run.
#pragma once

namespace alphadot {

/// Listens for its lifetime; without it signals do what they do by default. Before stops_safely() there is
/// nothing to save, and a signal to end ends the program at once with the exit code of interrupted runs.
/// After it a second SIGTERM or SIGINT does. From its beginning on, to the program's end, output that nobody
/// reads any more (SIGPIPE) is lost and no reason to end.
class SignalListener {
 public:
  SignalListener();
  ~SignalListener();
  SignalListener(const SignalListener&) = delete;
  SignalListener& operator=(const SignalListener&) = delete;
};

/// From now on the run looks whether it has been asked to end.
void stops_safely();

/// Whether this rank has been asked for a checkpoint since the last call.
bool take_checkpoint_signal();

/// Whether this rank has been asked to end.
bool stop_signalled();

}  // namespace alphadot
