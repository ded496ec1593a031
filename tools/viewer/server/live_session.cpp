#include "live_session.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "../../flags.h"
#include "../../output_names.h"
#include "../../stopwatch.h"
#include "onmesh/base/text.h"
#include "onmesh/filter/length.h"
#include "onmesh/image/image_io.h"
#include "onmesh/mesh_io/write_gltf.h"

namespace onmesh::tools {
namespace {

using nlohmann::json;

std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

HttpResponse response(int status, const json& value) {
  return {status, "application/json", text_of(value)};
}

HttpResponse error(int status, const std::string& sentence) {
  return response(status, {{"error", sentence}});
}

/// Calls work(); errors of the library's options come out in flags.
template <class Work>
auto in_words_of_flags(Work work) {
  try {
    return work();
  } catch (const OptionError& error) {
    throw UsageError(flag_of_field(error.option()) + ": " + in_flags(error.problem()));
  }
}

json job_json(const std::optional<Job>& job) {
  if (!job) return nullptr;
  return {{"number", job->number},
          {"kind", job->kind},
          {"state", name_of(job->state)},
          {"stage", job->stage},
          {"fraction", job->fraction},
          {"message", job->message},
          {"has_result", job->result != nullptr}};
}

/// What onmesh filter reads that onmesh view was told of.
std::vector<std::string> reading_words(const Arguments& arguments) {
  std::vector<std::string> words{arguments.argument("mesh")};
  if (arguments.has("texture")) {
    for (const std::string& texture : arguments.texts("texture")) {
      words.emplace_back("--texture");
      words.push_back(texture);
    }
  }
  for (const char* const name : {"wrap", "slot", "uv-set"}) {
    if (!arguments.given(name)) continue;
    words.push_back(dashed(name));
    words.push_back(arguments.text(name));
  }
  if (arguments.flag("confine")) words.emplace_back("--confine");
  return words;
}

std::vector<std::string> words_with(const std::vector<std::string>& words, const json& body) {
  std::vector<std::string> all = words;
  const std::vector<std::string> more = words_of(body.value("options", json::object()));
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Vec3 point_of(const json& body) {
  const json point = body.value("point", json());
  if (!point.is_array() || point.size() != 3) throw UsageError("point: is not three numbers");
  Vec3 p;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!point[k].is_number()) throw UsageError("point: is not three numbers");
    p[Eigen::Index(k)] = point[k].get<double>();
  }
  if (!p.allFinite()) throw UsageError("point: is not finite");
  return p;
}

bool flag_of(const json& body, const char* name) {
  const json value = body.value(name, json());
  return value.is_boolean() && value.get<bool>();
}

std::string string_of(const json& body, const char* name, const std::string& otherwise) {
  const json value = body.value(name, json());
  return value.is_string() ? value.get<std::string>() : otherwise;
}

}  // namespace

std::string why_no_file_name(const std::string& name) {
  const bool is_odd = std::any_of(name.begin(), name.end(), [](unsigned char c) {
    return c < 32 || c == 127 || c == '/' || c == '\\';
  });
  if (name.empty() || name.size() > 200 || is_odd || name[0] == '.')
    return "The name of a file without folders is needed";
  const std::filesystem::path path(name);
  if (!path.has_extension() || is_gltf_name(name))
    return "The name needs an image's ending, such as .png";
  return {};
}

LiveSession::LiveSession(const Arguments& arguments, const RenderOptions& camera)
    : arguments_(arguments),
      camera_(camera),
      words_(reading_words(arguments)),
      scene_(std::make_shared<LiveScene>(words_, arguments, camera)) {}

std::shared_ptr<LiveScene> LiveSession::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

HttpResponse LiveSession::answer(const HttpRequest& request) {
  const Endpoint endpoint = endpoint_of(request);
  const bool is_get = request.method == "GET";
  if (endpoint.name.empty() || endpoint.name == "status" || endpoint.name == "result") {
    if (!is_get) return error(405, "That is only to be read");
    return endpoint.name.empty() ? page() : endpoint.name == "status" ? status() : result();
  }
  const auto known = {"preview", "run", "save", "distance", "samples", "cancel"};
  if (std::find(known.begin(), known.end(), endpoint.name) == known.end())
    return error(404, "There is nothing of that name");
  if (is_get) return error(405, "That takes a POST");
  const json body = json::parse(request.body, nullptr, false);
  if (!body.is_object()) return error(400, "The request holds no JSON object");
  return post(endpoint.name, body);
}

HttpResponse LiveSession::post(const std::string& endpoint, const json& body) {
  if (endpoint == "cancel") return response(200, {{"cancelled", jobs_.cancel()}});
  if (endpoint == "run") return begin_run(body);
  if (endpoint == "preview")
    return when_done(endpoint, true, [=, this](auto& p) { return preview(body, p); });
  if (endpoint == "distance")
    return when_done(endpoint, true, [=, this](auto& p) { return distance(body, p); });
  if (endpoint == "samples")
    return when_done(endpoint, true, [=, this](auto& p) { return samples(body, p); });
  return when_done(endpoint, false, [=, this](auto&) { return save(body); });
}

HttpResponse LiveSession::page() {
  if (!changed_file(scene()->stamps()).empty())
    when_done("read", false, [this](auto&) {
      read_again();
      return std::string();
    });
  return {200, "text/html", scene()->page()};
}

/// Files may have become others: all is made anew of them.
void LiveSession::read_again() {
  auto fresh = std::make_shared<LiveScene>(words_, arguments_, camera_);
  full_run_ = {};
  const auto job = jobs_.last("read");
  const std::lock_guard lock(mutex_);
  scene_ = std::move(fresh);
  last_reading_ = job ? job->number : 0;
}

std::optional<Job> LiveSession::last_run() const {
  const std::optional<Job> job = jobs_.last("run");
  const std::lock_guard lock(mutex_);
  return job && job->number > last_reading_ ? job : std::nullopt;
}

HttpResponse LiveSession::status() {
  return response(200, {{"job", job_json(jobs_.last())}, {"run", job_json(last_run())}});
}

HttpResponse LiveSession::result() {
  const std::optional<Job> job = last_run();
  if (!job || !job->result) return error(404, "There is no result of a full run");
  return {200, "application/json", *job->result};
}

HttpResponse LiveSession::when_done(const std::string& kind, bool is_replaceable, Jobs::Work work) {
  Job busy;
  const auto number = jobs_.start(
      kind, is_replaceable,
      [work = std::move(work)](const Progress& progress) {
        return in_words_of_flags([&] { return work(progress); });
      },
      busy);
  if (!number) return error(409, "Another job is not over yet: " + busy.kind);
  const std::optional<Job> job = jobs_.wait(*number);
  if (!job || !job->is_over() || job->state == JobState::cancelled)
    return response(409, {{"error", "It was cancelled"}, {"cancelled", true}});
  if (job->state == JobState::failed) return error(422, job->message);
  return {200, "application/json", *job->result};
}

HttpResponse LiveSession::begin_run(const json& body) {
  Job busy;
  const auto number = jobs_.start(
      "run", false,
      [=, this](const Progress& progress) {
        return in_words_of_flags([&] { return run(body, progress); });
      },
      busy);
  if (!number) return error(409, "Another job is not over yet: " + busy.kind);
  return response(202, {{"job", *number}});
}

std::string LiveSession::preview(const json& body, const Progress& progress) {
  Stopwatch watch;
  const Arguments arguments = filter_arguments(words_with(words_, body));
  const std::shared_ptr<LiveScene> shown = scene();
  const LiveResult result = shown->textures(arguments).preview(arguments, progress);
  return shown->preview_answer(result, watch.total());
}

std::string LiveSession::run(const json& body, const Progress& progress) {
  Stopwatch watch;
  const std::shared_ptr<LiveScene> shown = scene();
  if (const std::string changed = changed_file(shown->stamps()); !changed.empty())
    throw InputError(changed +
                     " is another file now than when it was read; reload this page to see "
                     "and filter the new one");
  FullRun full{words_with(words_, body), {}};
  const Arguments arguments = filter_arguments(full.words);
  LiveResult result = shown->textures(arguments).run(arguments, progress);
  progress("answer", 0);
  std::string text = shown->run_answer(result, watch.total());
  full.images = std::move(result.images);
  full_run_ = std::move(full);
  return text;
}

std::string LiveSession::save(const json& body) {
  const std::string name = string_of(body, "name", "");
  if (const std::string why = why_no_file_name(name); !why.empty()) throw UsageError(why);
  if (full_run_.images.empty()) throw UsageError("There is no full run to be saved");
  std::vector<std::string> words = full_run_.words;
  words.push_back("--output=" + name);
  const Arguments arguments = filter_arguments(words);
  LiveTextures& textures = scene()->textures(arguments);
  json there = json::array(), saved = json::array();
  for (const auto& path : name_outputs(textures.inputs().set, name).paths) {
    if (path.empty()) continue;
    std::error_code none;
    const bool is_plain = !path.has_parent_path() && why_no_file_name(path.string()).empty();
    if (!is_plain || std::filesystem::is_symlink(path, none) ||
        std::filesystem::is_directory(path, none))
      throw UsageError(path.string() + " is no plain file of the folder");
    if (std::filesystem::exists(path, none)) there.push_back(path.string());
    saved.push_back(path.string());
  }
  textures.check_destination(arguments);
  const bool may_write =
      flag_of(body, "confirmed") && (there.empty() || flag_of(body, "overwrite"));
  if (!may_write) return text_of({{"asks", saved}, {"exists", there}});
  const std::vector<std::string> warnings = textures.write(arguments, full_run_.images);
  return text_of({{"saved", saved}, {"warnings", warnings}});
}

std::string LiveSession::distance(const json& body, const Progress& progress) {
  DistanceQuestion question;
  question.point = point_of(body);
  question.backend = string_of(body, "backend", "auto");
  question.compares = flag_of(body, "compare");
  question.needs_surface = flag_of(body, "needs_surface");
  return scene()->distances().answer(question, progress);
}

std::string LiveSession::samples(const json& body, const Progress& progress) {
  const std::shared_ptr<LiveScene> shown = scene();
  const Length length = parse_length("spacing", string_of(body, "spacing", ""));
  return shown->distances().samples(shown->length_of(length), progress);
}

}  // namespace onmesh::tools
