"""Arc trees and levels: the features, their order, and how they are nested. Imports msc."""
