#pragma once

#include "pipeline/ledger/file_lock.h"
#include "pipeline/ledger/ledger.h"
#include "tiling/rect.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace hsgm::pipeline {

/// What to do where another process has the ledger.
enum class WhenHeld {
    refuse,    ///< throw StorageError, naming it
    wait,      ///< until it is free; throws Interrupted
    give_way,  ///< return nothing
    take_over, ///< take it away, by a copy: its holder can record nothing more
};

/// A ledger that this process owns, by its lock.
class OwnedLedger {
public:
    struct Manner {
        WhenHeld when_held = WhenHeld::refuse;
        bool fleeting = false;             ///< need not survive a power cut
        std::function<void()> once_locked; ///< called before the ledger is opened
    };
    /// Opens or begins the ledger and becomes its owner. A requeued job takes over from its
    /// own earlier attempt; so does any with WhenHeld::take_over: it goes on in a successor of
    /// the ledger. A damaged ledger is set aside, with a warning, and a new one begun.
    static std::optional<OwnedLedger> take(const std::filesystem::path& path,
                                           const Manner& manner);

    ledger::Ledger& operator*() const { return *ledger_; }
    ledger::Ledger* operator->() const { return ledger_.get(); }
    const ledger::Owner& owner() const { return owner_; }

    /// Carries out a piece of work on the image as a whole, with a row of its own: running,
    /// then done, or pending again where it throws.
    void record(const std::string& stage, const tiling::Rect& whole,
                const std::function<void()>& work) const;
    /// Whether such a piece is done.
    bool is_done(const std::string& stage) const;

private:
    OwnedLedger() = default;
    void take_over(const std::filesystem::path& path, const Manner& manner);

    std::optional<ledger::FileLock> lock_;
    std::unique_ptr<ledger::Ledger> ledger_;
    ledger::Owner owner_;
};

} // namespace hsgm::pipeline
