#include "run/frame.hpp"

#include "thixis/core/log.hpp"

namespace thixis::drive {

Frame::Frame(const RunParams& params, const models::Model& model, const core::Deck& deck, const core::Comm& comm, const Versions& versions,
             const output::StoredCheckpoint* stored)
    : params_(params),
      model_(model),
      deck_(deck),
      comm_(comm),
      versions_(versions),
      stored_(stored),
      directory_(params.output.directory),
      checkpoint_(directory_.checkpoint(), params, deck),
      goes_on_(stored && same_directory(*stored, params, directory_.path())) {}

Written Frame::before(const Written& by_interrupted) const {
  Written written = goes_on_ ? by_interrupted : Written{};
  written.seconds = by_interrupted.seconds;
  return written;
}

void Frame::begin(const std::string& from) {
  open(directory_, params_, deck_, goes_on_, comm_);
  introduce(deck_, model_, comm_, versions_);
  if (stored_) {
    core::log::info("goes on from {}", from);
    say_differences(*stored_, params_);
  }
  if (!goes_on_) remove_file(checkpoint_.path(), comm_);
}

core::ExitCode Frame::end(const Found& found, const Verdict& verdict, const std::string& invitation) const {
  summarize(params_, model_, found, verdict, comm_, clock_.seconds(), versions_).write(directory_.summary(), comm_);
  say_doubts(found.estimate, found.doubts);
  return conclude(directory_, verdict, invitation, comm_, clock_.seconds());
}

}  // namespace thixis::drive
