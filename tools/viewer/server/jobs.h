// The work that the window's page asks for: one job at a time, on a thread of its own.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "onmesh/base/progress.h"

namespace onmesh::tools {

/// Where a job is.
enum class JobState { waiting, running, done, failed, cancelled };

std::string name_of(JobState state);

/// What is known of a job.
struct Job {
  int number = 0;    ///< from 1
  std::string kind;  ///< "preview", "run", ...
  JobState state = JobState::waiting;
  std::string stage;                          ///< as Progress has it
  double fraction = 0;                        ///< of the stage
  std::string message;                        ///< why it failed
  std::shared_ptr<const std::string> result;  ///< of one that is done
  bool is_over() const {
    return state == JobState::done || state == JobState::failed || state == JobState::cancelled;
  }
};

/// Runs jobs. Each result is kept until the next job of its kind begins, so that it can be fetched
/// again. All members may be called from any thread.
class Jobs {
 public:
  /// \throw std::exception, whose text becomes the job's message
  using Work = std::function<std::string(const Progress&)>;

  Jobs();
  /// Cancels what runs and waits for its end.
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Begin a job. A newer one of a kind that is replaceable takes the place of an older one.
  /// \return its number; nothing if another job has to end first, which `busy` receives
  std::optional<int> start(const std::string& kind, bool is_replaceable, Work work, Job& busy);
  /// The last job that began, whatever its kind; nothing before there was one.
  std::optional<Job> last() const;
  /// The last job of a kind.
  std::optional<Job> last(const std::string& kind) const;
  /// Wait until a job is over.
  /// \return nothing if it is not known any more; not over if the end of all has come
  std::optional<Job> wait(int number) const;
  /// \return whether there was anything to cancel
  bool cancel();
  /// Cancel what runs, let nothing begin, and let wait() return.
  void end();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace onmesh::tools
