// SPDX-License-Identifier: GPL-3.0-or-later
// A robot does not own its actions: the program deletes them, before or after the robot, and each
// parts from the other. An action is of one robot at a time.
//
// fire() of the highest priority comes first; those below get the merged wish of all above, those
// of equal priority the same one.
#ifndef SIM_ARIA_ACTION_H
#define SIM_ARIA_ACTION_H

#include <cstddef>
#include <list>
#include <map>
#include <string>
#include <vector>

#include <sim_aria/action_desired.h>
#include <sim_aria/argument.h>

class ArRobot;

/// A behaviour of a robot: fire() computes the motion that it wants in each cycle. It is called in
/// the thread of the cycle with the robot's lock held, so it may read the robot and must not sleep.
class ArAction {
  public:
    explicit ArAction(const char* name, const char* description = "")
        : myName(name), myDescription(description) {}
    /// Removes itself from its robot.
    virtual ~ArAction();
    ArAction(const ArAction&) = delete;
    ArAction& operator=(const ArAction&) = delete;

    virtual bool isActive() const { return myActive; }
    virtual void activate() { myActive = true; }
    virtual void deactivate() { myActive = false; }

    /// \param currentDesired the motion that actions of higher priority want
    /// \return null without a wish
    virtual ArActionDesired* fire(ArActionDesired currentDesired) = 0;
    /// Called by ArRobot::addAction().
    virtual void setRobot(ArRobot* robot) { myRobot = robot; }
    ArRobot* getRobot() const { return myRobot; }
    virtual ArActionDesired* getDesired() { return nullptr; }

    const char* getName() const { return myName.c_str(); }
    const char* getDescription() const { return myDescription.c_str(); }
    int getNumArgs() const { return static_cast<int>(myArguments.size()); }
    ArArg* getArg(int number) {
        return number >= 0 && number < getNumArgs() ? &myArguments[static_cast<std::size_t>(number)]
                                                    : nullptr;
    }
    ArArg* getArg(const char* name) {
        for (ArArg& argument : myArguments)
            if (std::string(argument.getName()) == name) return &argument;
        return nullptr;
    }
    virtual void log(bool verbose = true) const {
        ArLog::log(ArLog::Terse, "Action %s, %s", getName(), isActive() ? "active" : "inactive");
        if (!verbose) return;
        for (const ArArg& argument : myArguments) argument.log();
    }

  protected:
    void setNextArgument(const ArArg& argument) { myArguments.push_back(argument); }

    ArRobot* myRobot = nullptr;

  private:
    friend class ArRobot;

    std::string myName, myDescription;
    std::vector<ArArg> myArguments;
    bool myActive = true;
};

/// Combines the wishes of all actions.
class ArResolver {
  public:
    using ActionMap = std::multimap<int, ArAction*>;

    explicit ArResolver(const char* name = "resolver", const char* description = "")
        : myName(name), myDescription(description) {}
    virtual ~ArResolver() {}
    virtual ArActionDesired* resolve(ActionMap* actions, ArRobot* robot,
                                     bool logActions = false) = 0;
    const char* getName() const { return myName.c_str(); }
    const char* getDescription() const { return myDescription.c_str(); }

  private:
    std::string myName, myDescription;
};

/// Takes wishes in descending priority until their strengths add up to 1, for speed and rotation
/// apart; averages those of equal priority. Of limits the lowest holds.
class ArPriorityResolver : public ArResolver {
  public:
    ArPriorityResolver() : ArResolver("ArPriorityResolver") {}

    ArActionDesired* resolve(ActionMap* actions, ArRobot* robot, bool logActions = false) override;

  private:
    ArActionDesired myDesired;
};

/// Actions that are switched on and off together.
class ArActionGroup {
  public:
    explicit ArActionGroup(ArRobot* robot);
    virtual ~ArActionGroup();
    ArActionGroup(const ArActionGroup&) = delete;
    ArActionGroup& operator=(const ArActionGroup&) = delete;

    /// Adds an action to the robot and to the group.
    virtual void addAction(ArAction* action, int priority);
    virtual void remAction(ArAction* action);
    void addActionToDelete(ArAction* action) { myOwned.push_back(action); }
    virtual void activate() {
        for (ArAction* action : myActions) action->activate();
    }
    /// Switches off all other actions of the robot.
    virtual void activateExclusive();
    virtual void deactivate() {
        for (ArAction* action : myActions) action->deactivate();
    }
    virtual void removeActions();
    std::list<ArAction*>* getActionList() { return &myActions; }

  protected:
    friend class ArRobot;

    ArRobot* myRobot;  // null once it is destroyed
    std::list<ArAction*> myActions, myOwned;
};

#endif  // SIM_ARIA_ACTION_H
