// The command line.
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <functional>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "app/centers.hpp"
#include "app/companion.hpp"
#include "app/described_case.hpp"
#include "app/verbs.hpp"
#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/memory.hpp"
#include "io/provenance.hpp"

namespace {

using namespace alphadot;

/// On standard error, which may have nobody at its other end.
void complain(const std::string& of_what, const std::string& text) {
  std::fputs(fmt::format("alphadot: {}: {}\n", of_what, text).c_str(), stderr);
}

/// Runs a verb; its errors are printed once, and every rank gets the exit code.
int guarded(const Communicator& comm, const std::function<RunStatus()>& verb) {
  try {
    return exit_code(verb());
  } catch (const InputError& error) {
    if (comm.is_root())
      for (const auto& problem : error.problems()) complain("error", problem.text());
  } catch (const std::bad_alloc&) {
    complain("error", out_of_memory(comm.rank()).text());
    if (comm.size() > 1) MPI_Abort(comm.handle(), exit_code(RunStatus::error));
  } catch (const FailedElsewhere&) {
    // That rank says why, and ends this one.
  } catch (const std::exception& error) {
    // Not foreseen, so other ranks may be waiting for this one: end them too.
    complain(fmt::format("internal error on rank {}", comm.rank()), error.what());
    if (comm.size() > 1) MPI_Abort(comm.handle(), exit_code(RunStatus::error));
  }
  return exit_code(RunStatus::error);
}

/// A verb whose result is what it prints: when that cannot be written it has failed.
RunStatus printed(const Communicator& comm, const std::function<RunStatus()>& verb) {
  RunStatus status = RunStatus::error;
  std::string fault;
  try {
    status = verb();
    errno = 0;
    if (std::fflush(stdout) != 0) fault = std::generic_category().message(errno);
  } catch (const std::runtime_error& error) {
    if (std::ferror(stdout) == 0) throw;
    fault = error.what();
  }
  comm.on_root([&] {
    if (!fault.empty())
      throw InputError("standard output", 0, fault,
                       "what was printed is not whole: print it to another place");
  });
  return status;
}

/// Checks an option; unlike CLI::Range it does not let what is not a number pass.
CLI::Validator number_from(Real least, Real most) {
  return {[least, most](const std::string& text) {
            Real value = 0;
            const bool is_good = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
            return is_good ? std::string() : fmt::format("{} is no number from {} to {}", text, least, most);
          },
          fmt::format("NUMBER from {} to {}", least, most)};
}

/// Checks a moment centre.
CLI::Validator center_text() {
  return {[](const std::string& text) {
            try {
              parse_center(text);
              return std::string();
            } catch (const InputError& error) {
              const auto& problem = error.problems().front();
              return problem.what + "; " + problem.remedy;
            }
          },
          "X[,Y,Z]"};
}

void add_case_arguments(CLI::App& verb, CaseArguments& arguments) {
  verb.add_option("case", arguments.case_file, "Case file (TOML), or a description that alphadot mesh knows")
      ->required();
  verb.add_option("--set", arguments.overrides, "Replace a key of the case, e.g. --set freestream.mach=2")
      ->type_name("KEY=VALUE")
      ->take_all();
}

/// Where a run writes and what it begins from; returns the option of the latter.
const CLI::Option* add_run_arguments(CLI::App& verb, CaseArguments& arguments) {
  verb.add_option("--out", arguments.folder, "Folder of the run (default: runs/<name of the case file>)");
  verb.add_flag("--overwrite", arguments.may_overwrite,
                "Replace other results in the folder, once those of this run stand");
  return verb.add_option("--restart", "Go on from a checkpoint (default: the newest of the folder)")
      ->type_name("FILE")
      ->expected(0, 1);
}

}  // namespace

int main(int argc, char** argv) {
  alphadot::keep_freed_memory();
  // Programs of their own, which want no MPI; their options are their own, too.
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb == "mesh") return become_companion("mesh.py", argc, argv);
  const auto asks_for_tolerance = [](const char* word) {
    return std::string_view(word).starts_with("--tolerance");
  };
  if (verb == "derivatives" && std::any_of(argv, argv + argc, asks_for_tolerance))
    return become_companion("adapt.py", argc, argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk, not the end
  const MpiSession mpi(argc, argv);
  const Communicator comm;

  CLI::App app{
      "Dynamic stability derivatives of missiles and aircraft by field velocity.\n"
      "Exit codes: 0 converged or completed, 1 error, 2 wrong command line, 3 interrupted, 4 diverged,\n"
      "5 not converged: something that was asked for was not reached, and the last line says what."};
  app.set_version_flag("--version", version_line());
  app.require_subcommand(1);
  app.fallthrough();
  bool quiet = false;
  app.add_flag("-q,--quiet", quiet, "Only warnings and errors");

  app.add_subcommand("mesh", "From the description of a missile to its mesh, case file and picture");

  CaseArguments arguments;
  auto& run = *app.add_subcommand("run", "Steady state, motion and derivatives of a case");
  add_case_arguments(run, arguments);
  const auto* run_restart = add_run_arguments(run, arguments);

  auto& derivatives = *app.add_subcommand(
      "derivatives", "Every stability derivative of a case from linear solves, no time stepping");
  add_case_arguments(derivatives, arguments);
  const auto* derivatives_restart = add_run_arguments(derivatives, arguments);
  std::string tolerance;  // a program of its own reads it
  derivatives
      .add_option(
          "--tolerance", tolerance,
          "Of a description: meshes adapted to derivatives until intervals are as small as 1%, 0.4 or "
          "2%CN_alphadot; --tolerance --help tells of its options")
      ->type_name("T");

  std::vector<std::string> loads;
  auto& adjoint = *app.add_subcommand(
      "adjoint", "What loads are sensitive to: one linear solve a load, for all flight variables at once");
  add_case_arguments(adjoint, arguments);
  adjoint
      .add_option(
          "--of", loads,
          "Loads, e.g. Cm,CN,Cm_alphadot or CN@fin_1+fin_2 of some walls or sets (default: all coefficients)")
      ->type_name("LOADS")
      ->delimiter(',');
  std::vector<std::string> goals;
  adjoint
      .add_option(
          "--indicator", goals,
          "Derivatives, e.g. Cm_alpha,Cm_q,Cm_alphadot: where on the mesh their errors are made, into "
          "indicator.vtkhdf, for alphadot mesh --sizes")
      ->type_name("DERIVATIVES")
      ->delimiter(',');
  const auto* adjoint_restart = add_run_arguments(adjoint, arguments);

  std::vector<Real> reduced_frequencies;
  auto& frequency = *app.add_subcommand(
      "frequency", "Derivatives at finite frequency: one complex linear solve a variable and frequency");
  add_case_arguments(frequency, arguments);
  frequency.add_option("--k", reduced_frequencies, "Reduced frequencies omega length / (2 V), e.g. 0.01,0.1")
      ->required()
      ->type_name("K")
      ->delimiter(',')
      ->check(number_from(1e-6, 1e3));
  bool with_gusts = false;
  frequency.add_flag("--gusts", with_gusts,
                     "The responses to waves of air that the stream carries too, across it, per w / V");
  const auto* frequency_restart = add_run_arguments(frequency, arguments);

  auto& check = *app.add_subcommand("check", "Check case and mesh without running");
  add_case_arguments(check, arguments);
  bool whole_case = false;
  check.add_flag("-v,--verbose", whole_case, "Print the case with every default filled in, too");

  PartitionArguments cut;
  auto& partition =
      *app.add_subcommand("partition", "Prepare a mesh once for reading by any number of ranks at once");
  partition.add_option("mesh", cut.mesh, "The mesh: any known format, or one prepared before")->required();
  partition.add_option("-n,--pieces", cut.pieces, "Pieces: the usual number of ranks")
      ->required()
      ->check(CLI::Range(1, 1'000'000));
  partition.add_option("-o,--output", cut.output, "Prepared mesh (default: beside the mesh, with .h5)");
  partition
      .add_option("--thin", cut.thin,
                  "Patch inside the mesh that becomes a wall with two sides; may be repeated")
      ->type_name("PATCH")
      ->take_all()
      ->allow_extra_args(false);
  partition.add_option("--refine", cut.refinements, "Times that every tetrahedron is cut into eight first")
      ->check(CLI::Range(0, 8));
  partition.add_option("--method", cut.partitioner, "metis (one rank cuts) or ptscotch (all ranks together)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Partitioner>{
          {"metis", Partitioner::metis}, {"ptscotch", Partitioner::ptscotch}}));

  DeriveArguments derivation;
  auto& derive = *app.add_subcommand("derive", "Derivatives of finished runs about any moment centres");
  derive.add_option("files", derivation.files, "history.h5 of motions, or result.json of run or derivatives")
      ->required();
  derive
      .add_option("--center", derivation.centers,
                  "Moment centre x or x,y,z in the unit of the reference length; may be repeated (default: "
                  "that of the run)")
      ->check(center_text())
      ->type_name("")
      ->take_all()
      ->allow_extra_args(false);
  derive
      .add_option("--centers", derivation.centers_file,
                  "File with a centre a line: x or x,y,z, # for remarks")
      ->type_name("FILE");
  derive.add_flag("--json", derivation.as_json, "Print a list of all files and centres as JSON");

  std::string file;
  auto& info = *app.add_subcommand("info", "What a mesh, history, checkpoint or result file holds");
  info.add_option("file", file, "The file")->required();

  bool once = false;
  Real interval = 2;
  auto& watch = *app.add_subcommand("watch", "Follow a run, or all runs of a sweep, in the terminal");
  watch.add_option("folder", file, "Folder of the run, or of the sweep")->required();
  watch.add_flag("--once", once, "Show the state once and end");
  watch.add_option("--interval", interval, "Seconds between two looks (default: 2)")
      ->check(number_from(0.1, 3600));

  auto& keys = *app.add_subcommand("keys", "Every key of the case file with its default and meaning");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    int code = error.get_exit_code();
    if (comm.is_root()) code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  for (const auto* restart : {run_restart, derivatives_restart, adjoint_restart, frequency_restart})
    if (*restart) arguments.restart = restart->results().empty() ? "" : restart->results().front();
  set_up_log(comm.is_root(), quiet);

  return guarded(comm, [&] {
    replace_description(arguments, comm);
    if (run) return run_verb(arguments, comm);
    if (derivatives) return derivatives_verb(arguments, comm);
    if (adjoint) return adjoint_verb(arguments, loads, goals, comm);
    if (frequency) return frequency_verb(arguments, reduced_frequencies, with_gusts, comm);
    if (partition) return partition_verb(cut, comm);
    return printed(comm, [&] {
      if (check) return check_verb(arguments, whole_case, comm);
      if (derive) return derive_verb(derivation, comm);
      if (info) return info_verb(file, comm);
      if (watch) return watch_verb(file, once, interval, comm);
      if (keys && comm.is_root()) fmt::print("{}", describe_case_keys());
      return RunStatus::completed;
    });
  });
}
