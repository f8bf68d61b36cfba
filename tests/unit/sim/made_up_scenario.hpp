#pragma once

#include <string>

#include "sim/scenario/scenario.hpp"

namespace a351::sim::scenario {

/// Returns a scenario of the program with more or other keys.
inline Scenario changed(const std::string& base, const std::string& more) {
    return parse_scenario("base = \"" + base + "\"\nname = \"x\"\n" + more, "x.toml");
}

/// Returns the text of a stay in 25 degC.
inline std::string stay(const std::string& site, const std::string& time,
                        const std::string& more = "", const std::string& date = "2017-07-16") {
    return "[[occupation]]\nsite = \"" + site + "\"\ncentre_utc = \"" + date + "T" + time +
           "Z\"\nambient_degc = 25\n" + more;
}

}  // namespace a351::sim::scenario
