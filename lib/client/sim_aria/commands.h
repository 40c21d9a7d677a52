// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers are those of the Pioneer 3 Operations Manual (MobileRobots 2006), client commands.
#ifndef SIM_ARIA_COMMANDS_H
#define SIM_ARIA_COMMANDS_H

/// Command numbers of a Pioneer. ArRobot::comInt supports ENABLE, SONAR, VEL, RVEL, MOVE, ROTATE,
/// HEAD, DHEAD, STOP, ESTOP, SETO, ENCODER and SIM_STAT; others are accepted without effect.
class ArCommands {
  public:
    enum Commands {
        PULSE = 0,
        OPEN = 1,
        CLOSE = 2,
        POLLING = 3,
        ENABLE = 4,
        SETA = 5,
        SETV = 6,
        SETO = 7,
        MOVE = 8,
        ROTATE = 9,
        SETRV = 10,
        VEL = 11,
        HEAD = 12,
        DHEAD = 13,
        SAY = 15,
        JOYINFO = 17,
        CONFIG = 18,
        ENCODER = 19,
        RVEL = 21,
        DCHEAD = 22,
        SETRA = 23,
        SONAR = 28,
        STOP = 29,
        DIGOUT = 30,
        VEL2 = 32,
        GRIPPER = 33,
        ADSEL = 35,
        GRIPPERVAL = 36,
        GRIPPERPACREQUEST = 37,
        IOREQUEST = 40,
        PTUPOS = 41,
        TTY2 = 42,
        GETAUX = 43,
        BUMPSTALL = 44,
        TCM2 = 45,
        JOYDRIVE = 47,
        HOSTBAUD = 50,
        AUX1BAUD = 51,
        AUX2BAUD = 52,
        ESTOP = 55,
        ESTALL = 56,
        GYRO = 58,
        TTY4 = 60,
        BATTERYINFO = 62,
        CALCOMP = 65,
        TTY3 = 66,
        GETAUX2 = 67,
        SOUND = 90,
        PLAYLIST = 91,
        SOUNDTOG = 92,
        LATVEL = 110,
        LATACCEL = 113,
        SIM_SET_POSE = 224,
        SIM_RESET = 225,
        SIM_LRF_ENABLE = 230,
        SIM_LRF_SET_FOV_START = 231,
        SIM_LRF_SET_FOV_END = 232,
        SIM_LRF_SET_RES = 233,
        SIM_CTRL = 236,
        SIM_STAT = 237,
        SIM_MESSAGE = 238,
        SIM_EXIT = 239,
        // Of later robots: these numbers are ours, as the commands have no effect.
        WHEEL_LIGHT = 240,
        MARCDEBUG = 241
    };
};

#endif  // SIM_ARIA_COMMANDS_H
