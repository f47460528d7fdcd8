#include "command_line.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "thixis/core/log.hpp"
#include "thixis/core/text.hpp"
#include "versions.hpp"

namespace thixis {
namespace {

constexpr const char* description =
    "Thixis solves problems with contact and other inequality constraints.\n\n"
    "  thixis run inputs/membranes/disk.xml                      solve a deck\n"
    "  mpirun -n 4 thixis run DECK --set mesh/refinements=5      on four ranks, one parameter changed\n"
    "  thixis restart results/disk/checkpoint.h5                 go on from where a run ended, on any number of ranks\n"
    "  thixis check DECK                                         judge a deck without solving it\n"
    "  thixis describe newton                                    every parameter of a block\n"
    "  thixis describe --format xml disk > new.xml               a deck to start from, for a model or a case\n\n"
    "Exit codes: 0 done, every 'expect' holds; 1 internal error; 2 command line or deck; 3 not converged;\n"
    "4 accuracy target or an 'expect' missed; 5 input or output; 6 told to end by a signal, with a checkpoint to go on from.";

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

class CommandLine {
 public:
  explicit CommandLine(const Commands& commands) {
    app_.name("thixis");
    app_.set_version_flag("--version", version_text());
    app_.require_subcommand(1);
    add_run(commands.run);
    add_restart(commands.restart);
    add_deck(add("check", "Judge a deck without solving it; all mistakes at once", commands.check));
    add_describe(commands.describe);
    add("cases", "The catalogued cases", commands.cases);
  }

  core::ExitCode obey(int argc, char** argv, const core::Comm& comm) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& wanted) {  // --help, --version
      if (comm.root()) app_.exit(wanted);
      return core::ExitCode::done;
    } catch (const CLI::ParseError& mistake) {
      const bool no_command = dynamic_cast<const CLI::RequiredError*>(&mistake) != nullptr && app_.get_subcommands().empty();
      throw core::InputError(fmt::format("thixis: {}\nRun 'thixis --help' for the commands and options.",
                                         no_command ? without_command(app_, argc, argv) : mistake.what()));
    }
    if (arguments_.quiet) core::log::set_level(core::log::Level::quiet);
    if (arguments_.verbose) core::log::set_level(core::log::Level::verbose);
    return command_(arguments_, comm);
  }

 private:
  CLI::App* add(const char* name, const char* sentence, Command action) {
    CLI::App* sub = app_.add_subcommand(name, sentence);
    sub->callback([this, action] { command_ = action; });
    return sub;
  }
  void add_overrides(CLI::App* sub) {
    sub->add_option("--set", arguments_.overrides, "PATH=VALUE: override one parameter, e.g. --set method/degree=3")->take_all();
  }
  void add_deck(CLI::App* sub) {
    sub->add_option("deck", arguments_.deck, "The deck (XML)")->required();
    add_overrides(sub);
  }
  void add_results(CLI::App* sub, const char* sentence) {
    sub->add_option("--output", arguments_.output, sentence);
    sub->add_flag("--quiet", arguments_.quiet, "Show the verdict only");
    sub->add_flag("--verbose", arguments_.verbose, "Show details")->excludes("--quiet");
  }
  void add_run(Command action) {
    CLI::App* sub = add("run", "Solve a deck and write the results", action);
    add_deck(sub);
    add_results(sub, "Folder of the results (default: results/<name of the deck>)");
  }
  void add_restart(Command action) {
    CLI::App* sub = add("restart", "Go on from a checkpoint, on any number of ranks", action);
    sub->add_option("checkpoint", arguments_.deck, "The checkpoint.h5 of a run")->required();
    add_overrides(sub);
    add_results(sub, "Folder of the results (default: that of the interrupted run)");
  }
  void add_describe(Command action) {
    CLI::App* sub = add("describe", "Every parameter: type, default, range, one sentence", action);
    sub->add_option("block", arguments_.block,
                    "A block of the deck, e.g. newton or newton/initial (default: all); with xml also a model or a case");
    sub->add_option("--format", arguments_.format, "text, markdown, or xml (a deck to start from)")
        ->transform(CLI::CheckedTransformer(std::map<std::string, core::Format>{
            {"text", core::Format::text}, {"markdown", core::Format::markdown}, {"xml", core::Format::xml}}));
  }

  CLI::App app_{description};
  Arguments arguments_;
  Command command_ = nullptr;
};

}  // namespace

core::ExitCode obey(int argc, char** argv, const Commands& commands, const core::Comm& comm) {
  return CommandLine(commands).obey(argc, argv, comm);
}

}  // namespace thixis
