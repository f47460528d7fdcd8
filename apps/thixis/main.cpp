/// thixis: what its commands do (run, restart, check, describe, cases).
#include <fmt/core.h>

#include <Tpetra_Core.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line.hpp"
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

constexpr Commands commands = {run, restart, check, describe, cases};

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
    return static_cast<int>(thixis::obey(static_cast<int>(own.size()), own.data(), thixis::commands, comm));
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
