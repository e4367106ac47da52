"""The coolinggen workbench: cooled turbine blades as parametric objects."""
