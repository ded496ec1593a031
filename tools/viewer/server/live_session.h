// What the window's page can ask for: a table of endpoints over one scene.
#pragma once

#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "../../arguments.h"
#include "http_message.h"
#include "jobs.h"
#include "live_scene.h"
#include "request_policy.h"

namespace onmesh::tools {

/// Whether a file of that name may be written: a plain name without folders, of an image.
/// \return why not; empty if it may
std::string why_no_file_name(const std::string& name);

/// Answers requests. All work is done by one job at a time, which alone touches the scene; requests
/// may come from any thread.
///
///     GET               the page
///     GET  status       {"job", "run"}: the last job, the last full run
///     GET  result       of the last full run
///     POST preview      {"options"} -> images of the reduced textures
///     POST run          {"options"} -> at once {"job"}; see status and result
///     POST save         {"name", "confirmed", "overwrite"} -> {"saved"}, or else what would be
///                       written and what of it exists: {"asks", "exists"}
///     POST distance     {"point", "backend", "compare", "needs_surface"} -> layers
///     POST samples      {"spacing"} -> points
///     POST cancel       ends the job that runs
///
/// Errors are {"error": sentence}, with 409 while another job runs.
class LiveSession {
 public:
  /// Reads the files.
  /// \param arguments of onmesh view
  /// \throw UsageError, FileError, InputError
  LiveSession(const Arguments& arguments, const RenderOptions& camera);

  HttpResponse answer(const HttpRequest& request);
  /// Requests that wait for a job return.
  void end() { jobs_.end(); }

 private:
  struct FullRun {
    std::vector<std::string> words;
    std::vector<Image> images;
  };

  HttpResponse page();
  HttpResponse status();
  HttpResponse result();
  HttpResponse post(const std::string& endpoint, const nlohmann::json& body);
  HttpResponse when_done(const std::string& kind, bool is_replaceable, Jobs::Work work);
  HttpResponse begin_run(const nlohmann::json& body);
  std::string preview(const nlohmann::json& body, const Progress& progress);
  std::string run(const nlohmann::json& body, const Progress& progress);
  std::string save(const nlohmann::json& body);
  std::string distance(const nlohmann::json& body, const Progress& progress);
  std::string samples(const nlohmann::json& body, const Progress& progress);
  /// The full run that belongs to what is shown.
  std::optional<Job> last_run() const;
  std::shared_ptr<LiveScene> scene() const;
  void read_again();

  Arguments arguments_;
  RenderOptions camera_;
  std::vector<std::string> words_;  ///< of onmesh filter, that say what is read
  mutable std::mutex mutex_;        ///< guards the next two
  std::shared_ptr<LiveScene> scene_;
  int last_reading_ = 0;  ///< the job that read the files; those before it are of other textures
  FullRun full_run_;
  Jobs jobs_;  ///< ends before what it uses does
};

}  // namespace onmesh::tools
