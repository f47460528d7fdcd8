/// thixis: the command line (run, restart, check, describe, cases).
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "registry.hpp"
#include "thixis/core/assert.hpp"
#include "thixis/core/deck.hpp"
#include "thixis/core/log.hpp"
#include "thixis/core/memory.hpp"
#include "thixis/core/text.hpp"
#include "thixis/drive/run.hpp"
#include "thixis/output/checkpoint.hpp"
#include "versions.hpp"

namespace thixis {
namespace {

struct Arguments {
  std::string deck, output, block;
  std::vector<std::string> overrides;
  bool quiet = false, verbose = false;
  core::Format format = core::Format::text;
};

/// f(deck, params, model) with the deck and its overrides, after everything is judged that needs no mesh. What shows only later gets its
/// place in the deck, too.
template <class F>
core::ExitCode with_deck(core::Deck deck, const Arguments& arguments, bool restart, F f) {
  for (const auto& assignment : arguments.overrides) deck.set(assignment);
  auto params = deck.parse(catalogue().schema());
  if (!arguments.output.empty()) params.output.directory = arguments.output;
  if (params.output.directory.empty()) params.output.directory = "results/" + deck.stem();
  try {
    // both parts of the judgement show their mistakes
    std::unique_ptr<models::Model> model;
    std::string mistakes;
    const auto collect = [&](auto part) {
      try {
        part();
      } catch (const core::InputError& mistake) {
        mistakes += (mistakes.empty() ? "" : "\n") + std::string(mistake.what());
      }
    };
    collect([&] { core::check_used(deck, catalogue().uses(), params, restart); });
    collect([&] { drive::check_served(params); });
    collect([&] { model = catalogue().make(params); });
    if (model) collect([&] { drive::check_wanted(params, *model); });
    if (!mistakes.empty()) throw core::InputError(mistakes);
    return f(deck, params, *model);
  } catch (const core::Error& error) {
    throw deck.located(error);
  }
}

core::ExitCode run(const Arguments& arguments, const core::Comm& comm) {
  return with_deck(core::Deck::read(arguments.deck, comm), arguments, false,
                   [&](const core::Deck& deck, const drive::RunParams& params, const models::Model& model) {
                     return drive::run(params, model, deck, comm, versions());
                   });
}

core::ExitCode restart(const Arguments& arguments, const core::Comm& comm) {
  const auto stored = output::read_checkpoint(arguments.deck, comm);
  return with_deck(core::Deck::from_text(stored.deck(), stored.path(), stored.folder()), arguments, true,
                   [&](const core::Deck& deck, const drive::RunParams& params, const models::Model& model) {
                     return drive::run(params, model, deck, comm, versions(), &stored);
                   });
}

core::ExitCode check(const Arguments& arguments, const core::Comm& comm) {
  return with_deck(core::Deck::read(arguments.deck, comm), arguments, false,
                   [](const core::Deck& deck, const drive::RunParams& params, const models::Model& model) {
                     drive::check_ahead(params, model);
                     core::log::info("{}: no mistakes found.", deck.file());
                     return core::ExitCode::done;
                   });
}

core::ExitCode describe(const Arguments& arguments, const core::Comm&) {
  const auto& schema = catalogue().schema();
  if (const auto params = catalogue().starting(arguments.block)) {
    if (arguments.format != core::Format::xml)
      throw core::InputError(
          fmt::format("thixis describe: '{}' is a scene, which is described as a deck; write --format xml.", arguments.block));
    core::log::info("{}", core::skeleton(schema, *params, catalogue().uses()));
    return core::ExitCode::done;
  }
  core::log::info("{}", core::describe(schema, arguments.block, arguments.format, catalogue().uses()));
  return core::ExitCode::done;
}

core::ExitCode cases(const Arguments&, const core::Comm&) {
  for (const models::Entry& model : catalogue().models())
    for (const models::Case& known : model.cases) core::log::info("{:<21}{:<26}{}", model.name, known.name, known.sentence);
  return core::ExitCode::done;
}

std::string version_text() {
  std::string text;
  for (const auto& [name, version] : versions()) text += fmt::format("{}{:<16}{}", text.empty() ? "" : "\n", name, version);
  return text;
}

/// What is wrong with a command line that names no command: CLI11 only says that one is required.
std::string without_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
  const char* const* word = std::find_if(argv + 1, argv + argc, [](const char* argument) { return argument[0] != '-'; });
  if (word == argv + argc) return "a command is missing; write one of " + core::join(names) + ".";
  return fmt::format("no such command '{}'. {}", *word, core::did_you_mean(*word, names, "Write one of"));
}

/// Parses the command line and does what it says.
core::ExitCode dispatch(int argc, char** argv, const core::Comm& comm) {
  using Command = core::ExitCode (*)(const Arguments&, const core::Comm&);
  Arguments arguments;
  Command command = nullptr;

  CLI::App app{
      "Thixis solves problems with contact and other inequality constraints.\n\n"
      "  thixis run inputs/membranes/disk.xml                      solve a deck\n"
      "  mpirun -n 4 thixis run DECK --set mesh/refinements=5      on four ranks, one parameter changed\n"
      "  thixis restart results/disk/checkpoint.h5                 go on from where a run ended, on any number of ranks\n"
      "  thixis check DECK                                         judge a deck without solving it\n"
      "  thixis describe newton                                    every parameter of a block\n"
      "  thixis describe --format xml disk > new.xml               a deck to start from, for a model or a case\n\n"
      "Exit codes: 0 done, every 'expect' holds; 1 internal error; 2 command line or deck; 3 not converged;\n"
      "4 accuracy target or an 'expect' missed; 5 input or output; 6 told to end by a signal, with a checkpoint to go on from."};
  app.name("thixis");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);

  const auto add = [&](const char* name, const char* sentence, Command action) {
    CLI::App* sub = app.add_subcommand(name, sentence);
    sub->callback([&command, action] { command = action; });
    return sub;
  };
  const auto add_overrides = [&](CLI::App* sub) {
    sub->add_option("--set", arguments.overrides, "PATH=VALUE: override one parameter, e.g. --set method/degree=3")->take_all();
  };
  const auto add_deck = [&](CLI::App* sub) {
    sub->add_option("deck", arguments.deck, "The deck (XML)")->required();
    add_overrides(sub);
  };
  const auto add_verbosity = [&](CLI::App* sub) {
    sub->add_flag("--quiet", arguments.quiet, "Show the verdict only");
    sub->add_flag("--verbose", arguments.verbose, "Show details")->excludes("--quiet");
  };
  CLI::App* solve = add("run", "Solve a deck and write the results", run);
  add_deck(solve);
  solve->add_option("--output", arguments.output, "Folder of the results (default: results/<name of the deck>)");
  add_verbosity(solve);
  CLI::App* resume = add("restart", "Go on from a checkpoint, on any number of ranks", restart);
  resume->add_option("checkpoint", arguments.deck, "The checkpoint.h5 of a run")->required();
  add_overrides(resume);
  resume->add_option("--output", arguments.output, "Folder of the results (default: that of the interrupted run)");
  add_verbosity(resume);
  add_deck(add("check", "Judge a deck without solving it; all mistakes at once", check));
  CLI::App* explain = add("describe", "Every parameter: type, default, range, one sentence", describe);
  explain->add_option("block", arguments.block,
                      "A block of the deck, e.g. newton or newton/initial (default: all); with xml also a model or a case");
  explain->add_option("--format", arguments.format, "text, markdown, or xml (a deck to start from)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, core::Format>{
          {"text", core::Format::text}, {"markdown", core::Format::markdown}, {"xml", core::Format::xml}}));
  add("cases", "The catalogued cases", cases);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help, --version
    if (comm.root()) app.exit(wanted);
    return core::ExitCode::done;
  } catch (const CLI::ParseError& mistake) {
    const bool no_command = dynamic_cast<const CLI::RequiredError*>(&mistake) != nullptr && app.get_subcommands().empty();
    throw core::InputError(fmt::format("thixis: {}\nRun 'thixis --help' for the commands and options.",
                                       no_command ? without_command(app, argc, argv) : mistake.what()));
  }
  if (arguments.quiet) core::log::set_level(core::log::Level::quiet);
  if (arguments.verbose) core::log::set_level(core::log::Level::verbose);
  return command(arguments, comm);
}

}  // namespace
}  // namespace thixis

int main(int argc, char** argv) {
  // Kokkos takes words like --help for its own: it is shown those only that begin with its name, the program the others
  std::vector<char*> kokkos = {argv[0]}, own = {argv[0]};
  for (int i = 1; i < argc; ++i) (std::string(argv[i]).rfind("--kokkos-", 0) == 0 ? kokkos : own).push_back(argv[i]);
  int kokkos_count = static_cast<int>(kokkos.size());
  char** kokkos_words = kokkos.data();
  Tpetra::ScopeGuard scope(&kokkos_count, &kokkos_words);
#ifdef THIXIS_ASSERTIONS
  thixis::core::enable_floating_point_traps();
#endif
  const thixis::core::Comm comm;
  thixis::core::Error last(thixis::core::ExitCode::internal, "");
  try {
    return static_cast<int>(thixis::dispatch(static_cast<int>(own.size()), own.data(), comm));
  } catch (const thixis::core::Error& error) {  // thrown on all ranks alike
    if (comm.root()) fmt::print(stderr, "{}\n", thixis::core::printable(error.what()));
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    last = thixis::core::as_error(error);
  } catch (const char* error) {  // thrown by NOX
    last = {thixis::core::ExitCode::internal, error};
  }
  const char* kind = last.code() == thixis::core::ExitCode::internal ? "internal error " : "";
  fmt::print(stderr, "thixis: {}on rank {}: {}\n", kind, comm.rank(), thixis::core::printable(last.what()));
  if (comm.size() > 1) MPI_Abort(comm.mpi(), static_cast<int>(last.code()));
  return static_cast<int>(last.code());
}
