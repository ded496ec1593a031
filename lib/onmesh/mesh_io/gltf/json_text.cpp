#include "onmesh/mesh_io/gltf/json_text.h"

#include <algorithm>
#include <cassert>

namespace onmesh {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::size_t skip_blanks(std::string_view text, std::size_t at) {
  return std::min(text.find_first_not_of(kBlanks, at), text.size());
}

/// One past the end of the string that begins at its quote.
std::size_t skip_string(std::string_view text, std::size_t at) {
  for (++at; text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return at + 1;
}

/// One past the end of a value.
std::size_t skip_value(std::string_view text, std::size_t at) {
  if (text[at] == '"') return skip_string(text, at);
  if (text[at] != '{' && text[at] != '[')
    return std::min(text.find_first_of(",]} \t\r\n", at), text.size());
  std::size_t depth = 0;
  do {
    if (text[at] == '"') {
      at = skip_string(text, at);
      continue;
    }
    if (text[at] == '{' || text[at] == '[') ++depth;
    if (text[at] == '}' || text[at] == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

/// Calls work() with where each value of an array or member of an object begins. It returns where
/// that ends.
/// \param at the bracket
template <class Work>
void for_each_in(std::string_view text, std::size_t at, const Work& work) {
  for (at = skip_blanks(text, at + 1); text[at] != '}' && text[at] != ']';) {
    at = skip_blanks(text, work(at));
    if (text[at] == ',') at = skip_blanks(text, at + 1);
  }
}

struct Member {
  std::size_t key_begin = 0, key_end = 0;  ///< with the quotes
  std::size_t begin = 0, end = 0;          ///< of the value
};

Member member_at(std::string_view text, std::size_t at) {
  Member member{at, skip_string(text, at), 0, 0};
  const std::size_t colon = skip_blanks(text, member.key_end);
  member.begin = skip_blanks(text, colon + 1);
  member.end = skip_value(text, member.begin);
  return member;
}

bool has_name(std::string_view text, const Member& member, std::string_view key) {
  const std::string_view quoted = text.substr(member.key_begin, member.key_end - member.key_begin);
  if (quoted.find('\\') == std::string_view::npos)
    return quoted.substr(1, quoted.size() - 2) == key;
  return nlohmann::json::parse(quoted).get_ref<const std::string&>() == key;
}

std::vector<Member> members_of(std::string_view text, std::size_t object) {
  std::vector<Member> members;
  for_each_in(text, object, [&](std::size_t at) {
    members.push_back(member_at(text, at));
    return members.back().end;
  });
  return members;
}

/// The last member of that name, or the end.
std::vector<Member>::const_iterator find_member(std::string_view text,
                                                const std::vector<Member>& members,
                                                std::string_view key) {
  const auto found = std::find_if(members.rbegin(), members.rend(), [&](const Member& member) {
    return has_name(text, member, key);
  });
  return found == members.rend() ? members.end() : found.base() - 1;
}

/// Where the value of a member begins.
std::size_t value_of(std::string_view text, std::size_t object, std::string_view key) {
  const std::vector<Member> members = members_of(text, object);
  const auto found = find_member(text, members, key);
  assert(found != members.end());
  return found->begin;
}

}  // namespace

JsonText::Object JsonText::element(const std::string& list, std::size_t i) {
  const auto [found, is_new] = lists_.try_emplace(list);
  std::vector<Object>& elements = found->second;
  if (is_new) {
    for_each_in(text_, value_of(text_, text_.find('{'), list), [&](std::size_t at) {
      elements.push_back(at);
      return skip_value(text_, at);
    });
  }
  return elements[i];
}

JsonText::Object JsonText::object(Object in, std::string_view key) const {
  return value_of(text_, in, key);
}

void JsonText::set(Object object, std::string_view key, const nlohmann::json& value) {
  const std::vector<Member> members = members_of(text_, object);
  assert(!members.empty());
  if (const auto found = find_member(text_, members, key); found != members.end()) {
    edits_[found->begin] = {found->end, value.dump()};
    return;
  }
  // A new member comes first, and looks like the one that was.
  const std::size_t at = object + 1;
  const Member& first = members[0];
  Edit& edit = edits_[at];
  edit.end = at;
  edit.text += text_.substr(at, first.key_begin - at);
  edit.text += nlohmann::json(key).dump();
  edit.text += text_.substr(first.key_end, first.begin - first.key_end);
  edit.text += value.dump() + ',';
}

std::string JsonText::edited() const {
  std::string result;
  std::size_t copied = 0;
  for (const auto& [begin, edit] : edits_) {
    result += text_.substr(copied, begin - copied);
    result += edit.text;
    copied = edit.end;
  }
  result += text_.substr(copied);
  return result;
}

}  // namespace onmesh
