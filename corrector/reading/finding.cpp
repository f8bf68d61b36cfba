#include "corrector/reading/finding.hpp"

#include <nlohmann/json.hpp>

namespace a351::corrector::reading {

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
    auto list = nlohmann::ordered_json::array();
    for (const Finding& finding : findings) {
        nlohmann::ordered_json one;
        one["kind"] = finding.kind;
        one["site"] = finding.site;
        one["occupation"] = finding.occupation;
        one["key"] = nullptr;
        if (!finding.key.empty()) one["key"] = finding.key;
        one["time_utc"] = to_rfc3339(finding.time, 3);
        one["text"] = finding.text;
        one["amendment"] = finding.amendment;
        list.push_back(std::move(one));
    }
    return list;
}

}  // namespace a351::corrector::reading
