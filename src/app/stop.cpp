#include "app/stop.hpp"

#include <unistd.h>

#include <csignal>
#include <initializer_list>

#include "core/run_status.hpp"

namespace alphadot {

namespace {

volatile std::sig_atomic_t checkpoint_asked = 0, stop_asked = 0, is_safe = 0;  // what a handler may touch

extern "C" void ask_for_checkpoint(int) {
  checkpoint_asked = 1;
}
extern "C" void ask_to_stop(int) {
  stop_asked = 1;
  if (is_safe != 0) return;
  constexpr char text[] = "alphadot: stopped by a signal before anything was computed\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(exit_code(RunStatus::error));
  _exit(exit_code(RunStatus::interrupted));
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

SignalListener::SignalListener() {
  handle(SIGUSR1, ask_for_checkpoint, 0);
  handle(SIGUSR2, ask_to_stop, 0);
  for (const int signal : {SIGTERM, SIGINT}) handle(signal, ask_to_stop, static_cast<int>(SA_RESETHAND));
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) handle(SIGHUP, ask_to_stop, 0);  // nohup lets a run go on
  handle(SIGPIPE, SIG_IGN, 0);
}

SignalListener::~SignalListener() {
  is_safe = 0;
  for (const int signal : {SIGUSR1, SIGUSR2, SIGTERM, SIGINT}) handle(signal, SIG_DFL, 0);
}

void stops_safely() {
  is_safe = 1;
}

bool take_checkpoint_signal() {
  const bool asked = checkpoint_asked != 0;
  if (asked) checkpoint_asked = 0;
  return asked;
}

bool stop_signalled() {
  return stop_asked != 0;
}

}  // namespace alphadot
