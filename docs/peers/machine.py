"""The axis file as a rigid machine in coordinates of the load: what a searcher is told."""

import math
import tomllib

TURN = 2.0 * math.pi

# Cut-off of a machine without transmission, Hz: as published for EMPS.
WIDEST = 100.0


def rigid_below(stiffness, inertia):
    """Half of the frequency at which the load swings with the motor held, Hz: above it the
    torque balance of a rigid machine does not hold."""
    return min(WIDEST, 0.5 * math.sqrt(stiffness / inertia) / TURN)


class Machine:
    """Known parameters, SI, in coordinates of the load (m or rad; N or N m).

    Every machine here has one degree of freedom for a regression of its torque balance:
    gain * effort = inertia * a + friction + gravity + what is hidden.
    """

    def __init__(self, path):
        with open(path, "rb") as file:
            told = tomllib.load(file)
        self.name = told["name"]
        make = {"joint": self._joint, "linear-motor": self._linear, "liu2025": self._screw}
        make[self.name](told)

    def _joint(self, told):
        parts, dry = told["mechanism"], told["friction"]
        self.ratio = parts["ratio"]  # motor rad per load rad
        self.motor_inertia = parts["motor_inertia_kg_m2"] * self.ratio**2
        self.inertia = parts["load_inertia_kg_m2"] + self.motor_inertia
        self.effort, self.gain = "torque_ref_n_m", self.ratio
        self.position = "position_rad"
        degree = math.radians(1.0)
        self.coulomb, self.stiction = dry["coulomb_n_m"], dry["stiction_n_m"]
        self.stribeck_speed = dry["stribeck_speed_deg_per_s"] * degree
        self.viscous = dry["viscous_n_m_s_per_rad"]
        self.presliding = self.coulomb / dry["bristle_stiffness_n_m_per_rad"]
        load = told["load"][0]
        self.gravity, self.hanging = load["torque_n_m"], load["hanging_at_deg"] * degree
        self.rotary, self.transmission, self.pole_pairs, self.pole_pitch = True, True, None, None
        self.cutoff = rigid_below(parts["gear_stiffness_n_m_per_rad"], parts["load_inertia_kg_m2"])

    def _linear(self, told):
        motor, dry = told["actuator"], told["friction"]
        self.ratio, self.motor_inertia = 1.0, 0.0
        self.inertia = told["mechanism"]["slide_mass_kg"]
        self.effort, self.gain = "iq_a", motor["force_constant_n_per_a"]
        self.position = "position_m"
        self.coulomb = self.stiction = dry["coulomb_n"]
        self.stribeck_speed, self.viscous = 1.0, dry["viscous_n_s_per_m"]
        self.presliding = dry["presliding_um"] * 1e-6
        self.gravity, self.hanging = 0.0, 0.0
        self.rotary, self.transmission, self.pole_pairs = False, False, None
        self.pole_pitch = motor["pole_pitch_mm"] * 1e-3
        self.cutoff = WIDEST

    def _screw(self, told):
        screw, motor, dry = told["mechanism"], told["actuator"], told["friction"]
        lead = screw["lead_mm"] * 1e-3
        self.ratio = r = TURN / lead
        rotor = math.pi / 32 * screw["density_kg_per_m3"] * (screw["diameter_mm"] * 1e-3) ** 4 * screw["length_mm"] * 1e-3
        self.motor_inertia = (screw["motor_inertia_kg_m2"] + screw["torque_sensor_inertia_kg_m2"] + rotor) * r**2
        self.inertia = screw["table_mass_kg"] + self.motor_inertia
        self.effort, self.gain = "iq_a", motor["torque_constant_n_m_per_a"] * r
        self.position = "position_m"
        rpm = TURN / 60.0
        self.coulomb, self.stiction = dry["coulomb_n_m"] * r, dry["stiction_n_m"] * r
        self.stribeck_speed = dry["stribeck_speed_rpm"] * rpm / r
        self.viscous = dry["viscous_n_m_per_rpm"] / rpm * r**2
        self.presliding = dry["coulomb_n_m"] / (dry["bristle_stiffness_n_m_per_rpm_s"] / rpm) / r
        self.gravity, self.hanging = 0.0, 0.0
        self.rotary, self.transmission, self.pole_pitch = False, True, None
        self.pole_pairs = motor["pole_pairs"]
        couplings = screw["motor_coupling_n_m_per_rad"], screw["screw_coupling_n_m_per_rad"]
        compliance = sum(1.0 / (k * r**2) for k in couplings) + 1.0 / screw["nut_stiffness_n_per_m"]
        self.cutoff = rigid_below(1.0 / compliance, screw["table_mass_kg"])
