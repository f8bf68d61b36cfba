#pragma once
/// @file
/// What a person changed about the occupations of a day afterwards, in a file of its own.
/// The record and the event log stay as they are.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "corrector/reading/occupation_list.hpp"

namespace a351::corrector {

/// An amendment as it was carried out.
struct Amendment {
    std::string kind;  ///< exclude, include, retime, rename.
    std::string site;  ///< With `occupation` and `set_up` as before all amendments.
    int occupation = 1;
    std::optional<int> set_up;  ///< Counts the set-ups of the stay; absent: all of them.
    std::string change;         ///< In words; empty where the kind says all.
    std::string reason;
};

/// Carries out the amendments of a TOML file: arrays of tables [[exclude]] (out of every fit) and
/// [[include]] (used 1), [[retime]] (start_utc, end_utc or both) and [[rename]] (to), each with site, occupation, set_up
/// (not of rename) and reason.  All speak of the occupations as they were in the list; a renamed stay
/// keeps its number where the other site has none of it, else gets the next.  Every window changed
/// has a note of it.
/// @return  in the order of kinds above, then of the file.
/// @throws InputError  unknown key, no reason, no such occupation or site, two that contradict.
std::vector<Amendment> amend(std::vector<OccupationWindow>& windows,
                             const std::filesystem::path& file,
                             const std::vector<text::Site>& sites);

/// One line each.
[[nodiscard]] std::string amendments_text(const std::vector<Amendment>& amendments);

[[nodiscard]] nlohmann::ordered_json amendments_json(const std::vector<Amendment>& amendments);

}  // namespace a351::corrector
