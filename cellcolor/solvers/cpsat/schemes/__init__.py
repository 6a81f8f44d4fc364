"""All optimal schemes of an instance."""
