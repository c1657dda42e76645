"""Arc trees and levels: which features there are, in which order and how they are nested. Imports msc."""
