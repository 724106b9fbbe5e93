#include "pipeline/ledger/fingerprint.h"

namespace hsgm::ledger {

namespace {

std::string value_in(const Facts& facts, const std::string& name)
{
    const auto found = facts.find(name);
    if (found == facts.end()) {
        return "absent";
    }
    return found->second.empty() ? "empty" : found->second;
}

} // namespace

std::vector<std::string> differences(const Facts& before, const Facts& now)
{
    Facts names = before;
    names.insert(now.begin(), now.end());
    std::vector<std::string> found;
    for (const auto& [name, value] : names) {
        const std::string old = value_in(before, name);
        const std::string young = value_in(now, name);
        if (old != young) {
            found.push_back(name + ": " + old + " before, " + young + " now");
        }
    }
    return found;
}

} // namespace hsgm::ledger
