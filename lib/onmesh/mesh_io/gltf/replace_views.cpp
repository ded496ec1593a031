#include "onmesh/mesh_io/gltf/replace_views.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "onmesh/mesh_io/gltf/compression.h"

namespace onmesh {
namespace {

/// Bytes of a buffer that something in the file speaks of.
struct Range {
  std::size_t begin = 0, end = 0;
  JsonText::Object holder = 0;           ///< has byteOffset and byteLength
  const std::string* content = nullptr;  ///< what comes there instead; null = they stay

  bool overlaps(const Range& other) const { return begin < other.end && other.begin < end; }
};

/// The ranges of one buffer, ascending.
std::vector<Range> ranges_of(GltfFile& file, Index buffer,
                             const std::map<Index, std::string>& content, JsonText& text) {
  std::vector<Range> ranges;
  const auto add = [&](const JsonPlace& place, JsonText::Object holder,
                       const std::string* replaced) {
    if (place.at("buffer").whole_number() != buffer) return;
    const std::size_t begin = place.whole_number("byteOffset", 0);
    ranges.push_back({begin, begin + place.at("byteLength").whole_number(), holder, replaced});
  };
  const std::size_t views = file.root().size_of("bufferViews");
  for (Index v = 0; v < views; ++v) {
    const JsonPlace place = file.element("bufferViews", v);
    const JsonText::Object holder = text.element("bufferViews", v);
    const auto replaced = content.find(v);
    add(place, holder, replaced == content.end() ? nullptr : &replaced->second);
    const auto extensions = place.find("extensions");
    if (const auto packed = extensions ? extensions->find(kMeshoptName) : std::nullopt)
      add(*packed, text.object(text.object(holder, "extensions"), kMeshoptName), nullptr);
  }
  std::stable_sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  return ranges;
}

/// The replaced ranges that nothing else speaks of, ascending: new bytes can take their place.
std::set<const Range*> replaceable(const std::vector<Range>& ranges) {
  std::set<const Range*> found;
  std::size_t end = 0;          // of all ranges so far
  const Range* last = nullptr;  // the one that ends there
  for (const Range& range : ranges) {
    const bool is_apart = last == nullptr || range.begin >= end;
    if (!is_apart) found.erase(last);
    if (is_apart && range.content != nullptr) found.insert(&range);
    if (last == nullptr || range.end >= end) {
      end = range.end;
      last = &range;
    }
  }
  return found;
}

/// Offsets that did not change stay unsaid where they were.
void set_offset(JsonText& text, const Range& range, std::size_t now) {
  if (range.begin != now) text.set(range.holder, "byteOffset", now);
}

std::string rebuild(std::string_view old, const std::vector<Range>& ranges, JsonText& text) {
  constexpr std::size_t kAlignment = 4;  // of the largest components
  const std::set<const Range*> in_place = replaceable(ranges);
  std::string bytes;
  std::size_t copied = 0;  // up to here `old` is in `bytes`, or was replaced
  for (const Range& range : ranges) {
    if (range.content != nullptr) {
      if (!in_place.contains(&range)) continue;
      bytes += old.substr(copied, range.begin - copied);
      set_offset(text, range, bytes.size());
      bytes += *range.content;
      copied = range.end;
      // What follows keeps its alignment.
      while (bytes.size() % kAlignment != copied % kAlignment) bytes += '\0';
    } else {
      // Those that overlap come after the last replaced one, or before the next.
      set_offset(text, range, bytes.size() + (range.begin - copied));
    }
  }
  bytes += old.substr(copied);
  for (const Range& range : ranges) {
    if (range.content == nullptr) continue;
    if (!in_place.contains(&range)) {
      bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
      set_offset(text, range, bytes.size());
      bytes += *range.content;
    }
    text.set(range.holder, "byteLength", range.content->size());
  }
  return bytes;
}

}  // namespace

std::map<Index, std::string> replace_views(GltfFile& file,
                                           const std::map<Index, std::string>& content,
                                           JsonText& text) {
  std::set<Index> changed;
  const std::size_t buffers = file.root().size_of("buffers");
  for (const auto& [view, bytes] : content)
    changed.insert(file.element("bufferViews", view).index("buffer", buffers));
  std::map<Index, std::string> result;
  for (const Index buffer : changed) {
    std::string& bytes = result[buffer];
    bytes = rebuild(file.buffer(buffer), ranges_of(file, buffer, content, text), text);
    text.set(text.element("buffers", buffer), "byteLength", bytes.size());
  }
  return result;
}

}  // namespace onmesh
